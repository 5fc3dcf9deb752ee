#!/usr/bin/env bash
# Debian's libraries for aarch64, unpacked into a folder: nothing of another architecture is installed on this machine.
# usage: aarch64_libraries.sh FOLDER
set -euo pipefail

folder=$(realpath -m "$1")
packages=(
  libeigen3-dev libnanoflann-dev libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 libfmt-dev libfmt9 liblzf-dev liblzf1 libtomlplusplus-dev
  libcli11-dev nlohmann-json3-dev libgtest-dev librapidcheck-dev liblemon-dev
)
[[ -e $folder/complete ]] && exit 0

rm -rf "$folder"
mkdir -p "$folder"/apt/{lists/partial,cache/archives/partial} "$folder/packages"
# Lists of their own, and no word of what this machine has installed.
options=(
  -q -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o APT::Sandbox::User=root
  -o Dir::State::lists="$folder/apt/lists" -o Dir::Cache="$folder/apt/cache" -o Dir::State::status=/dev/null
)
apt-get "${options[@]}" update
(cd "$folder/packages" && apt-get "${options[@]}" download "${packages[@]}")
for package in "$folder"/packages/*.deb; do dpkg-deb -x "$package" "$folder"; done
rm -r "$folder/apt" "$folder/packages"
touch "$folder/complete"
