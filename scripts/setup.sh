#!/usr/bin/env bash
# Installs the Debian packages that the build and the tests need; extra package names may follow as arguments.
# Quick and silent when nothing is missing; otherwise it says what it runs before it runs it.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libeigen3-dev libnanoflann-dev libtbb-dev libfmt-dev liblzf-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev
  libjs-three libjs-chart.js
  libgtest-dev librapidcheck-dev libbenchmark-dev liblemon-dev python3 python3-numpy python3-scipy
  python3-dev python3-venv ccache
  "$@"
)

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup: not a Debian system, nothing installed; the build needs what these Debian packages hold:" >&2
  echo "  ${packages[*]}" >&2
  exit 0
fi

installed=" $(dpkg-query -W -f '${db:Status-Abbrev}${Package} ' "${packages[@]}" 2>/dev/null || true)"
missing=()
for package in "${packages[@]}"; do
  [[ $installed == *" ii $package "* || $installed == *" hi $package "* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "setup: run as root, or install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
run() {
  echo "setup: $*"
  "$@" </dev/null
}

# A stale or unreachable list of some other source must not stop us: the installation below is what counts.
run "${as_root[@]}" apt-get update -q || echo "setup: some package lists could not be brought up to date, going on" >&2
run "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
