# SPDX-License-Identifier: MIT
# A newcomer needs two commands: `make test` and `make reproduce-chapter4`. Each installs missing
# packages.

PROFILE ?= quick
PRESET ?= release
REFERENCE_SPP ?= 100000
JOBS ?= $(shell nproc)
BENCH ?= .
STIFFNESS ?= results/chapter4/stiffness

CHAPTER4 = $(if $(filter full,$(PROFILE)),results/chapter4,build/chapter4)
REPORT = $(if $(wildcard build/bin/rtrays-experiment),build/bin/rtrays-experiment report,scripts/results report)

.PHONY: all install programs picture build reproduce-chapter4 report check test test-asan test-full peers specialisation scaling stability stiffness instructions bench references format lint clean

all: build

install:
	scripts/install

programs: install
	cmake --preset $(PRESET)
	cmake --build --preset $(PRESET) -j $(JOBS) --target rtrays-render rtrays-reference rtrays-experiment mpi_programs

# The Cornell box as an image for display and as an EXR with all layers.
picture: programs
	build/bin/rtrays-render scenes/cornell_box/scene.json -o build/cornell_box.png -o build/cornell_box.exr --spp 256

build: install
	cmake --preset $(PRESET)
	cmake --build --preset $(PRESET) -j $(JOBS)

# Runs all experiments of chapter 4 with their report. Resumable.
reproduce-chapter4: programs
	build/bin/rtrays-experiment reproduce chapter4 --profile $(PROFILE) --out $(CHAPTER4)

# Writes tables, plots, pages and the overview from the existing run.json files. Without a build, as
# in a fresh clone, the stored pictures are used.
report:
	$(REPORT) $(dir $(wildcard $(CHAPTER4)/*/run.json))

# Lint and the unit tests, which need no device: under two minutes after a build.
check: build lint
	ctest --test-dir build --output-on-failure -j $(JOBS) -L unit

# Builds everything, runs the unit tests under the address and undefined-behaviour sanitizers, then
# lint and all tests. The last lines are the summary of ctest.
test: build test-asan lint
	ctest --test-dir build --output-on-failure -j $(JOBS)

# Without the two longest tests: others call the same functions with fewer samples.
test-asan: install
	cmake --preset asan
	cmake --build --preset asan -j $(JOBS) --target host_tests
	ctest --test-dir build-asan --output-on-failure -j $(JOBS) -L unit \
	    -E 'Emission.BringsTheIrradianceThatLightSamplesFind|BsdfSampling.FollowsItsDensity'

# Runs the full versions of tests; takes hours and is resumable:
#   * 1e7 rays on every mesh and layout, compared with Embree, and 1e8 rays inside closed shapes;
#   * all feature scenes with the renderer and the reference, with a contact sheet, and with every
#     algorithm;
#   * every scene with only the required features compiled in and with all features. This step starts
#     over when resumed, but takes kernels from the cache;
#   * the stages of all algorithms with each feature switched off;
#   * films of many ranks with all algorithms, and ranks that are killed ten times, if MPI is installed.
# The outputs are evidence and are kept in results/.
test-full: programs
	build/bin/rtrays-experiment run experiments/robustness/traversal.json --profile full --out results/chapter4/traversal
	scripts/results page results/chapter4/traversal
	for agreement in feature_scenes algorithms; do \
	    build/bin/rtrays-experiment run experiments/gates/$$agreement.json --profile full --out build/$$agreement || exit $$?; \
	    mkdir -p results/$$agreement; \
	    cp build/$$agreement/run.json build/$$agreement/agreement.md results/$$agreement/; \
	done
	scripts/results contact-sheet build/feature_scenes results/feature_scenes/contact_sheet.png
	scripts/same_bits build/bin features > results/same_bits.txt.new
	mv results/same_bits.txt.new results/same_bits.txt
	cmake --build --preset $(PRESET) -j $(JOBS) --target feature_build_test
	RTRAYS_ALL_BUILDS=1 build/bin/feature_build_test
	[ ! -x build/bin/rtrays-mpi ] || cluster/program_test.py build/bin/rtrays-mpi build/bin scenes --full

# Compares Mitsuba 3 and Blender's Cycles (scripts/install --peers) with the Embree reference;
# resumable. The exit code of the script is 77 if they are not installed. RTRAYS_MESHES adds
# third-party scenes.
peers: programs
	scripts/peers --profile full

# Measures the savings from specialised kernels on the Cornell box. Needs an idle machine.
specialisation: programs
	scripts/specialisation build/bin/rtrays-render scenes/cornell_box/scene.json > results/specialisation.md.new
	mv results/specialisation.md.new results/specialisation.md

# Measures how a reference scales with the ranks of this machine (scripts/install --mpi). Needs an
# idle machine.
scaling: programs
	scripts/scaling build/bin/rtrays-mpi scenes/cornell_box/scene.json > results/scaling.md.new
	mv results/scaling.md.new results/scaling.md

# Renders stiff and extreme cases with every algorithm that supports them, and writes a table. The
# exit code of the program is 3 if a case fails.
stability: programs
	build/bin/rtrays-experiment run experiments/robustness/stability.json --profile $(PROFILE) --out build/stability.$(PROFILE); code=$$?; \
	build/bin/rtrays-experiment report build/stability.$(PROFILE) && exit $$code

# Measures where each algorithm fails as roughness and light size approach zero. Needs an idle
# machine and takes a quarter of an hour.
stiffness: programs
	build/bin/rtrays-experiment run experiments/robustness/stiffness.json --profile full --out $(STIFFNESS)
	scripts/results page $(STIFFNESS)

# Counts the instructions per ray for each hierarchy layout and for Embree. Needs Valgrind, which
# scripts/install does not install.
instructions: programs
	scripts/instructions build/bin/rtrays-render build/bin/rtrays-reference scenes/cornell_bumps/scene.json > results/instructions.md.new
	mv results/instructions.md.new results/instructions.md

# Benchmarks the hierarchy against Embree's: rays per second per mesh and ray type, and build times;
# and edits of a scene in a session.
# Needs an idle machine. BENCH=sphere, a regular expression, selects some of the benchmarks. The
# experiments bvh_build and ray_rates write tables of the same measurements.
bench: install
	cmake --preset $(PRESET)
	cmake --build --preset $(PRESET) -j $(JOBS) --target benchmark_ray_rates benchmark_bvh_build benchmark_scene_update
	for program in ray_rates bvh_build scene_update; do \
	    build/bin/benchmark_$$program --benchmark_filter='$(BENCH)' --benchmark_counters_tabular=true \
	        --benchmark_out=build/$$program.json --benchmark_out_format=json || exit $$?; \
	done

# Renders the references of results/references/, as halves a and b with REFERENCE_SPP samples per
# pixel each. Resumable.
references: programs
	scripts/references $(REFERENCE_SPP)

format:
	scripts/install --tests
	git ls-files '*.h' '*.cpp' '*.cl' | xargs clang-format -i

# Checks what no compiler checks: format, style of scripts, prose, links and generated blocks.
lint:
	scripts/install --tests
	scripts/lint

clean:
	rm -rf build build-debug build-asan
