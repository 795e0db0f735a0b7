#!/bin/sh
# Makes the Python environment of the CAN tests in the folder $1: cantools reads the DBC, autosar-e2e is the oracle of the
# checksums. Needs Debian's python3-venv; the packages come from PyPI. Does nothing when the folder has them.
set -eu

folder=$1
here=$(cd "$(dirname "$0")" && pwd)
wanted="$folder/requirements.txt"
if [ -x "$folder/bin/python" ] && cmp -s "$here/requirements.txt" "$wanted"; then
    exit 0
fi
rm -rf "$folder"
python3 -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
cp "$here/requirements.txt" "$wanted"
