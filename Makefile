# The short way in: every target sets up what is missing, then calls CMake with a preset of CMakePresets.json.
PREFIX ?= /usr/local
jobs := $(shell nproc)
igsp := build/release/bin/igsp
demo := build/demo

.PHONY: all build setup demo test wheel bench calibrate asan tsan fuzz format install clean

all: build

setup:
	@scripts/setup.sh

build: setup
	cmake --preset release
	cmake --build --preset release

# Only the command, not the tests: an answer soon after a fresh clone.
demo: setup
	cmake --preset release
	cmake --build --preset release --target igsp_app
	$(igsp) simulate park --out $(demo)
	$(igsp) align $(demo)/station_1.ply $(demo)/station_0.ply --transform $(demo)/estimate.txt
	$(igsp) evaluate --transform $(demo)/estimate.txt --truth $(demo)/station_1_to_0.txt --source $(demo)/station_1.ply

test: build
	ctest --preset release -j $(jobs)

# The Python package, into dist/.
wheel: setup
	/usr/bin/python3 -m venv build/wheel
	CXX=c++ build/wheel/bin/pip wheel . --no-deps --wheel-dir dist  # the compiler of the presets: ccache knows its objects

asan tsan: setup
	cmake --preset $@
	cmake --build --preset $@
	ctest --preset $@ -j $(jobs)

bench: setup
	cmake --preset release -DIGSP_BUILD_BENCHMARKS=ON
	cmake --build --preset release
	set -e; for benchmark in build/release/bin/*_benchmark; do $$benchmark; done

# What docs/verdict.md shows: the rows, the numbers, the plots. About ten minutes of one core.
calibrate:
	@scripts/setup.sh python3-matplotlib
	cmake --preset release -DIGSP_BUILD_BENCHMARKS=ON
	cmake --build --preset release --target igsp_calibrate
	build/release/bin/igsp_calibrate --pairs 1000 --jobs $(jobs) --out docs/data/calibration.csv
	/usr/bin/python3 benchmarks/calibration/reliability.py

# New inputs land in build/fuzz/inputs; a crash is written beside the Makefile and stops the run.
fuzz_seconds ?= 60
fuzz:
	@scripts/setup.sh clang-14 libclang-rt-14-dev
	cmake --preset fuzz
	cmake --build --preset fuzz
	mkdir -p build/fuzz/inputs
	TMPDIR=/dev/shm build/fuzz/bin/read_points_fuzzer -max_len=4096 -max_total_time=$(fuzz_seconds) build/fuzz/inputs fuzz/corpus

format:
	@scripts/setup.sh clang-format
	git ls-files '*.hpp' '*.cpp' | xargs clang-format -i

install: build
	cmake --install build/release --prefix $(PREFIX)

clean:
	rm -rf build
