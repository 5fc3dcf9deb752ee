# The short way in: every target sets up what is missing, then calls CMake with a preset of CMakePresets.json.
PREFIX ?= /usr/local
jobs := $(shell nproc)
igsp := build/release/bin/igsp
demo := build/demo

.PHONY: all build setup demo test deb container docs wheel wheels bench bench-scrambles bench-peers aarch64 compilers coverage profile calibrate paper asan asan_unit tsan fuzz mutants tidy format install clean

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

# What only the tests need. dpkg-dev, file and fakeroot make and install the packages, the shells and mandoc judge completion and
# manual page, MkDocs builds the site, Chromium opens the report page, qemu-user is another processor, Clang another
# compiler.
test_packages := dpkg-dev fakeroot file fish man-db mandoc mkdocs-material zsh chromium chromium-driver python3-selenium qemu-user clang-14
test: build
	@scripts/setup.sh $(test_packages)
	ctest --preset release -j $(jobs)

# The Python package, into dist/.
wheel: setup
	/usr/bin/python3 -m venv build/wheel
	CXX=c++ build/wheel/bin/pip wheel . --no-deps --wheel-dir dist  # the compiler of the presets: ccache knows its objects

# The source distribution and a wheel for each Python of this machine, into dist/: see scripts/wheels.py.
wheels: setup
	cmake --preset release
	cmake --build --preset release --target igsp_app
	CXX=c++ /usr/bin/python3 scripts/wheels.py build/wheels dist build/release/bin/igsp

asan: test_packages += libclang-rt-14-dev
asan tsan:
	@scripts/setup.sh $(test_packages)
	cmake --preset $@
	cmake --build --preset $@
	ctest --preset $@ -j $(jobs)

# The unit tests alone, as .ci/run begins: three minutes where ccache knows the sources.
asan_unit:
	@scripts/setup.sh clang-14 libclang-rt-14-dev
	cmake --preset asan
	cmake --build --preset asan --target igsp_tests
	seq 0 $$(($(jobs) - 1)) | xargs -P $(jobs) -I shard \
	  env GTEST_TOTAL_SHARDS=$(jobs) GTEST_SHARD_INDEX=shard build/asan/bin/igsp_tests --gtest_brief=1

bench: setup
	@scripts/setup.sh valgrind  # its header, for igsp_profile
	cmake --preset release -DIGSP_BUILD_BENCHMARKS=ON
	cmake --build --preset release
	set -e; for benchmark in build/release/bin/*_benchmark; do $$benchmark; done

# Every case under twenty scrambles: the first tables of docs/benchmarks.md. Eight minutes of one core.
scans ?= ../shared/data
bench-scrambles: setup
	cmake --preset release
	cmake --build --preset release --target igsp_app
	rm -f docs/data/cases_20_scrambles.csv
	/usr/bin/python3 benchmarks/scrambles.py $(igsp) $(scans)/cases.csv docs/data/cases_20_scrambles.csv --jobs $(jobs)

# igsp and other programs on the same pairs: docs/benchmarks-peers.md, its rows and pictures. Hours for all of it; what is
# left of an interrupted run is done by the next. A part of it: peers_options="--every 4 --minutes 50", "--only bunny".
peers_cases ?= ../shared/data/cases.csv
peers_options ?=
peers_python := build/peers-venv/bin/python
bench-peers:
	@scripts/setup.sh libpcl-dev python3-venv libgl1 libgomp1 libx11-6
	cmake --preset release -DIGSP_BUILD_PEERS=ON
	cmake --build --preset release --target igsp_app pcl_peer
	test -x $(peers_python) || /usr/bin/python3 -m venv build/peers-venv
	grep -v '^#' benchmarks/peers/requirements.txt | while read -r package; do \
	  $(peers_python) -m pip install --quiet "$$package" || echo "cannot be installed: $$package"; done
	$(peers_python) benchmarks/peers/bench_peers.py --cases $(peers_cases) $(peers_options)
	$(peers_python) benchmarks/peers/summary.py
	$(peers_python) benchmarks/peers/plots.py

# What docs/verdict.md shows: the rows, the numbers, the plots. About half an hour of one core.
calibrate:
	@scripts/setup.sh python3-matplotlib
	cmake --preset release -DIGSP_BUILD_BENCHMARKS=ON
	cmake --build --preset release --target igsp_calibrate
	build/release/bin/igsp_calibrate --pairs 1000 --jobs $(jobs) --out docs/data/calibration.csv
	build/release/bin/igsp_calibrate --first 1000 --pairs 1000 --jobs $(jobs) --out docs/data/calibration_second.csv
	build/release/bin/igsp_calibrate --first 2000 --pairs 1000 --jobs $(jobs) --out docs/data/calibration_third.csv
	/usr/bin/python3 benchmarks/calibration/reliability.py

# What docs/paper/ shows: the paper's tables and figures, with the real scans in `scans` if they are there. About ten
# minutes of one core.
paper_data := docs/paper/data
paper:
	@scripts/setup.sh python3-matplotlib libpcl-dev
	cmake --preset release -DIGSP_BUILD_BENCHMARKS=ON -DIGSP_BUILD_PEERS=ON
	cmake --build --preset release --target igsp_paper pcl_peer
	mkdir -p $(paper_data)
	grep -m1 -oP 'model name\s*: \K.*' /proc/cpuinfo > $(paper_data)/machine.txt || uname -m > $(paper_data)/machine.txt
	build/release/bin/igsp_paper pairs --scans $(scans) --pairs build/paper
	cp build/paper/cases.csv $(paper_data)/pairs.csv
	build/release/bin/igsp_paper registrations --pairs build/paper --data $(paper_data)
	build/release/bin/igsp_paper parameters --pairs build/paper --data $(paper_data)
	build/release/bin/igsp_paper growth --data $(paper_data)
	/usr/bin/python3 benchmarks/paper/run_peers.py --program build/release/bin/pcl_peer --pairs build/paper --data $(paper_data)
	/usr/bin/python3 benchmarks/paper/figures.py --data $(paper_data) --out docs/paper
	/usr/bin/python3 benchmarks/paper/pictures.py --pairs build/paper --data $(paper_data) --out docs/paper
	/usr/bin/python3 benchmarks/paper/report.py --data $(paper_data) --out docs/paper/README.md

# The command and the unit tests for aarch64, by Debian's cross compiler, run under qemu-user. Scenes, answers on simulated
# pairs and, with the real scans, on the first case of each group must have the bits of this machine's; so must those of an
# x86-64 without AVX and without fused multiply-add. Slow: an emulated processor is about thirty times as slow.
aarch64_libraries := build/aarch64-libraries
aarch64_run = qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH=$(abspath $(aarch64_libraries))/usr/lib/aarch64-linux-gnu
aarch64_tests ?= *
same_bits = /usr/bin/python3 scripts/same_bits.py --cases $(scans)/cases.csv
aarch64: build
	@scripts/setup.sh g++-aarch64-linux-gnu qemu-user
	scripts/aarch64_libraries.sh $(aarch64_libraries)
	cmake --preset aarch64
	cmake --build --preset aarch64 --target igsp_app igsp_tests
	$(aarch64_run) build/aarch64/bin/igsp_tests --gtest_brief=1 '--gtest_filter=$(aarch64_tests)'
	$(same_bits) --plain-libm $(igsp) -- qemu-x86_64 -cpu Nehalem $(igsp)
	$(same_bits) $(igsp) -- $(aarch64_run) build/aarch64/bin/igsp

# The command by other compilers and optimisations: what differs from the release build, as docs/promises.md shows it.
compilers: setup
	@scripts/setup.sh clang-14
	cmake --preset release
	cmake --build --preset release --target igsp_app
	set -e; for each in "g++ -O0" "g++ -O2" "clang++-14 -O2"; do echo "== $$each"; set -- $$each; folder=build/compilers/$$1$$2; \
	  cmake -S . -B $$folder -G Ninja -DCMAKE_BUILD_TYPE=Release -DIGSP_BUILD_TESTS=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_COMPILER=$$1 \
	    -DCMAKE_CXX_FLAGS_RELEASE="$$2 -DNDEBUG" >/dev/null; \
	  cmake --build $$folder --target igsp_app >/dev/null; \
	  /usr/bin/python3 scripts/same_bits.py $(igsp) -- $$folder/bin/igsp || true; done

# What docs/profile.md shows: instructions a stage, counted by callgrind. Some minutes of one core.
profile:
	@scripts/setup.sh valgrind binutils
	cmake --preset release -DIGSP_BUILD_BENCHMARKS=ON
	cmake --build --preset release --target igsp_profile
	/usr/bin/python3 scripts/instructions.py build/release/bin/igsp_profile docs/profile.md

# Every target for a minute. New inputs land in build/fuzz/inputs; a crash is written beside the Makefile and stops the
# run.
fuzz_seconds ?= 60
fuzz_targets ?= ply pcd las text transformation options table run assignment archive align
fuzz:
	@scripts/setup.sh clang-14 libclang-rt-14-dev
	cmake --preset asan
	cmake --build --preset fuzz
	set -e; for target in $(fuzz_targets); do mkdir -p build/fuzz/inputs/$$target; \
	  TMPDIR=/dev/shm build/asan/bin/$${target}_fuzzer -max_len=4096 -timeout=60 -max_total_time=$(fuzz_seconds) \
	    build/fuzz/inputs/$$target fuzz/corpus; done

# One mistake at a time in the method's formulas: which test notices? Hours for all of them; a part of it:
# mutants_options="--only energy", "--every 5".
mutants_options ?=
mutants: setup
	/usr/bin/python3 scripts/mutants.py --jobs $(jobs) $(mutants_options)

# Which lines and branches of library and command the tests run: a summary, and build/coverage/index.html line by line. A
# part of it: coverage_tests="--tests-regex Verdict".
coverage_tests ?=
coverage: setup
	@scripts/setup.sh $(test_packages) gcovr
	cmake --preset coverage
	cmake --build --preset coverage
	ctest --preset coverage -j $(jobs) $(coverage_tests)
	gcovr --root . --filter src/ --filter apps/ --filter include/ --exclude '.*_test(ing)?\.[ch]pp' --exclude-throw-branches \
	  --exclude-unreachable-branches --html-details build/coverage/index.html --print-summary build/coverage

# Likely mistakes by the short list in .clang-tidy: what it finds is an error. Slow; a part of it by a regular
# expression of paths: tidy_sources='src/io/'.
tidy_sources ?= /(src|apps)/.*(?<!_test)\.cpp$$|/Unity/
tidy:
	@scripts/setup.sh clang-tidy-14
	cmake --preset release
	run-clang-tidy-14 -p build/release -quiet -j $(jobs) '$(tidy_sources)'

format:
	@scripts/setup.sh clang-format
	git ls-files '*.hpp' '*.cpp' | xargs clang-format -i

install: build
	cmake --install build/release --prefix $(PREFIX)

# build/deb/igsp_*.deb, the command, and build/deb/libigsp-dev_*.deb, the library to build with.
deb: setup
	@scripts/setup.sh dpkg-dev file
	cmake --preset release
	cmake --build --preset release --target igsp_app
	cpack --config build/release/CPackConfig.cmake -B build/deb

# An image of the command on Debian slim.
container: deb
	docker build --tag igsp --file Containerfile build/deb

# The documentation site, build/site/index.html, with its links checked.
docs: setup
	@scripts/setup.sh mkdocs-material
	cmake --preset release
	cmake --build --preset release --target igsp_app
	/usr/bin/python3 tests/site_test.py $(igsp) build/site

clean:
	rm -rf build
