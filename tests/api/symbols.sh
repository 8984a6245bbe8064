#!/usr/bin/env bash
# The shared library shows just what its header declares, and knows where it is to be found again.
#   symbols.sh LIBRARY HEADER
set -euo pipefail
library=$1 header=$2
shown=$(nm -D --defined-only "$library" | awk '{print $3}' | sort)
declared=$(grep -oE '\brepose_[a-z_]+\(' <(grep -A1 '^REPOSE_API' "$header") | tr -d '(' | sort -u)
if ! diff <(echo "$declared") <(echo "$shown"); then
  echo "the library shows other symbols (>) than the header declares (<)" >&2
  exit 1
fi
readelf -d "$library" | grep -q 'SONAME.*librepose\.so\.[0-9]' || { echo "no SONAME with a version" >&2; exit 1; }
echo "$(echo "$shown" | wc -l) symbols"
