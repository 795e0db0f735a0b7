#!/bin/sh
# Puts the Unity test framework into $1/src from Debian's archive: the source package cjson carries it.
# Leaves apt's own configuration alone: the source entry lives in a folder of its own.
set -eu

folder=$1
[ ! -f "$folder/src/unity.c" ] || exit 0
mkdir -p "$folder/src" "$folder/examples"
folder=$(cd "$folder" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# shellcheck source=/dev/null
. /etc/os-release
echo "deb-src http://deb.debian.org/debian ${VERSION_CODENAME:-bookworm} main" >"$work/sources.list"
mkdir -p "$work/lists/partial" "$work/cache/archives/partial"

own_apt() {
    apt-get -q -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::State::Lists="$work/lists" -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" \
        -o APT::Get::List-Cleanup=0 "$@"
}

cd "$work"
own_apt update
own_apt source --download-only cjson
tar -xzf cjson_*.orig.tar.gz
cp cJSON-*/tests/unity/examples/unity_config.h "$folder/examples/" # this copy of Unity includes it
cp cJSON-*/tests/unity/src/unity.h cJSON-*/tests/unity/src/unity_internals.h cJSON-*/tests/unity/src/unity.c "$folder/src/"
echo "Unity for the tests is in $folder/src"
