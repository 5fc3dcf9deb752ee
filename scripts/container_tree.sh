#!/usr/bin/env bash
# Does to a fresh Debian tree what Containerfile does to its image, then runs the command in it: for machines without a
# container engine. Needs root and debootstrap.
#   scripts/container_tree.sh build/deb build/container_tree
set -euo pipefail

context=$(realpath "$1")
tree=$(realpath -m "$2")
file=$(dirname "$0")/../Containerfile
suite=$(sed -n 's/^FROM debian:\([a-z]*\)-slim$/\1/p' "$file")
mirror=$(awk '/^URIs:/ {print $2; exit}' /etc/apt/sources.list.d/*.sources 2>/dev/null || true)

[[ -e $tree/etc/debian_version ]] || debootstrap --variant=minbase "$suite" "$tree" ${mirror:+"$mirror"}

while read -r step arguments; do
  case $step in
    '' | '#'* | FROM) ;;
    COPY) # shellcheck disable=SC2086  # the pattern is to be filled in
      (cd "$context" && cp ${arguments% *} "$tree${arguments##* }") ;;
    RUN) chroot "$tree" sh -c "$arguments" ;;
    WORKDIR) mkdir -p "$tree$arguments" && workdir=$arguments ;;
    ENTRYPOINT) entry=$(tr -d '[]",' <<<"$arguments") ;;
    *) echo "container_tree: does not know $step" >&2 && exit 1 ;;
  esac
done <"$file"

inside() { chroot --userspec=65534:65534 "$tree" sh -c "cd $workdir && $entry $*"; }
chmod 777 "$tree$workdir"
inside --version
inside simulate park --points 60000 --out .
inside align station_1.ply station_0.ply -o aligned.ply --transform estimate.txt
inside evaluate --transform estimate.txt --truth station_1_to_0.txt --source station_1.ply
