#!/usr/bin/env bash
# The shared library shows just what its headers declare, and knows where it is to be found again.
#   symbols.sh LIBRARY FOLDER_OF_HEADERS
set -euo pipefail
library=$1 headers=$2
shown=$(nm -D --defined-only "$library" | awk '{print $3}' | sort)
declared=$(grep -oE '\brepose_[a-z_]+\(' <(grep -h -A1 '^REPOSE_API' "$headers"/*.h) | tr -d '(' | sort -u)
if ! diff <(echo "$declared") <(echo "$shown"); then
  echo "the library shows other symbols (>) than the headers declare (<)" >&2
  exit 1
fi
readelf -d "$library" | grep -q 'SONAME.*librepose\.so\.[0-9]' || { echo "no SONAME with a version" >&2; exit 1; }
echo "$(echo "$shown" | wc -l) symbols"
