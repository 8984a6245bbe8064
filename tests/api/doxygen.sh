#!/usr/bin/env bash
# The public headers as doxygen reads them: all that is C has a comment, and no comment says what is not so.
#   doxygen.sh DOXYGEN SOURCE
set -euo pipefail
doxygen=$1
cd "$2"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; } | "$doxygen" -
# The wrapper's functions are named as those that repose.h explains, and may go without.
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; echo "FILE_PATTERNS = *.h *.hpp"; echo "WARN_IF_UNDOCUMENTED = NO"; } |
  "$doxygen" -
ls "$folder"/html/*8h.html | wc -l
