# SPDX-License-Identifier: MIT
# The two commands of a newcomer are `make test` and `make reproduce-chapter4`; each installs what is missing.

PROFILE ?= quick
REFERENCE_SPP ?= 100000
JOBS ?= $(shell nproc)
BENCH ?= .
STIFFNESS ?= results/chapter4/stiffness

STIFF_CASES = $(PROFILE:quick=ci)
CHAPTER4 = $(if $(filter full,$(PROFILE)),results/chapter4,build/chapter4)
EXPERIMENTS = cornell_diffuse cornell_algorithms cornell_bumps cornell_mirrors samplers mirror_ring glass_goblets door_ajar floor_lamps
MEASUREMENTS = reference_agreement traversal bvh_build bvh_animation ray_rates frame_times bounces binning ablations

.PHONY: all install programs build reproduce-chapter4 report test test-asan test-full peers specialisation stability stiffness instructions bench references format lint clean

all: build

install:
	scripts/install

programs: install
	cmake --preset release
	cmake --build --preset release -j $(JOBS) --target rtrays-render rtrays-reference rtrays-experiment

build: install
	cmake --preset release
	cmake --build --preset release -j $(JOBS)

# Kernels of what has no result yet come first, those of as many experiments at a time as there are cores: PoCL compiles on
# one. The quick profile has the stiff cases that CI has.
reproduce-chapter4: programs
	@printf '%s\n' $(if $(wildcard $(CHAPTER4)/stability/stability.json),,"stability.json --profile $(STIFF_CASES)") \
	    $(foreach e,$(EXPERIMENTS),$(if $(wildcard $(CHAPTER4)/$e/run.json),,"$e.json --profile $(PROFILE)")) \
	    | (cd experiments && xargs -r -P $(JOBS) -L 1 -t ../build/bin/rtrays-experiment run --compile)
	@step() { n=$$((n + 1)); echo "[$$n of $(words $(MEASUREMENTS) $(EXPERIMENTS) stability convergence_control)] $$1"; }; n=0; \
	for experiment in $(MEASUREMENTS) $(EXPERIMENTS); do \
	    step $$experiment; \
	    build/bin/rtrays-experiment run experiments/$$experiment.json --profile $(PROFILE) --out $(CHAPTER4)/$$experiment || exit $$?; \
	done; \
	step stability; \
	build/bin/rtrays-experiment run experiments/stability.json --profile $(STIFF_CASES) --out $(CHAPTER4)/stability || [ $$? -eq 3 ] || exit 1; \
	step convergence_control; \
	build/bin/rtrays-experiment control experiments/convergence_control.json --profile $(PROFILE) --out $(CHAPTER4)/convergence_control
	$(if $(filter full,$(PROFILE)),$(MAKE) --no-print-directory stiffness STIFFNESS=$(CHAPTER4)/stiffness)
	$(MAKE) --no-print-directory report

# Tables, plots and pages from the run.json files that are there.
report:
	/usr/bin/python3 scripts/measurements $(addprefix $(CHAPTER4)/,$(MEASUREMENTS))
	build/bin/rtrays-experiment report $(addprefix $(CHAPTER4)/,$(EXPERIMENTS))

# The renderer's host code under address and undefined-behaviour sanitizers, then everything; the last lines are ctest's summary.
test: build test-asan lint
	scripts/install --tests
	ctest --test-dir build --output-on-failure -j $(JOBS)

test-asan: install
	cmake --preset asan
	cmake --build --preset asan -j $(JOBS) --target host_tests
	ctest --test-dir build-asan --output-on-failure -j $(JOBS) -L host

# The heavy versions, hours, resumable: 1e7 rays on every mesh and layout beside Embree's and 1e8 out of closed shapes; all
# feature scenes by renderer and reference, with a contact sheet, and by every algorithm; every scene with what it needs
# compiled in and with everything (that goes through all of them again, but with kernels from the cache). What they print is
# evidence and is kept in results/.
test-full: programs
	build/bin/rtrays-experiment run experiments/traversal.json --profile full --out results/chapter4/traversal
	/usr/bin/python3 scripts/measurements results/chapter4/traversal
	for agreement in feature_scenes algorithms; do \
	    build/bin/rtrays-experiment agree experiments/$$agreement.json --profile full --out build/$$agreement || exit $$?; \
	    mkdir -p results/$$agreement; \
	    cp build/$$agreement/agreement.json build/$$agreement/agreement.md results/$$agreement/; \
	done
	scripts/contact_sheet build/feature_scenes results/feature_scenes/contact_sheet.png
	scripts/same_bits build/bin features > results/same_bits.txt.new
	mv results/same_bits.txt.new results/same_bits.txt

# Mitsuba 3 and Blender's Cycles (scripts/install --peers) against the Embree reference, resumable; exit code 77 where they
# are not installed. RTRAYS_MESHES adds scene files of others.
peers: programs
	scripts/peers --profile full

# What leaving out saves on the Cornell box; on an idle machine.
specialisation: programs
	scripts/specialisation build/bin/rtrays-render scenes/cornell_box/scene.json > results/specialisation.md.new
	mv results/specialisation.md.new results/specialisation.md

# Stiff and extreme cases by every algorithm that can render them: a table, and exit code 3 if one fails.
stability: programs
	build/bin/rtrays-experiment run experiments/stability.json --profile $(PROFILE) --out build/stability.$(PROFILE)

# Roughness and light size towards zero: where each algorithm fails; on an idle machine, a quarter of an hour.
stiffness: programs
	build/bin/rtrays-experiment run experiments/stiffness.json --profile full --out $(STIFFNESS)
	/usr/bin/python3 scripts/stiffness $(STIFFNESS)

# Instructions per ray by layout and by Embree, counted by Valgrind, which scripts/install does not install.
instructions: programs
	scripts/instructions build/bin/rtrays-render build/bin/rtrays-reference scenes/cornell_bumps/scene.json > results/instructions.md.new
	mv results/instructions.md.new results/instructions.md

# The hierarchy beside Embree's: rays per second by mesh and kind of ray, and how long it takes to build; on an idle machine.
# A part of them: BENCH=sphere (a regular expression). The experiments bvh_build and ray_rates make tables of the same turns.
bench: install
	cmake --preset release
	cmake --build --preset release -j $(JOBS) --target benchmark_ray_rates benchmark_bvh_build
	for program in ray_rates bvh_build; do \
	    build/bin/benchmark_$$program --benchmark_filter='$(BENCH)' --benchmark_counters_tabular=true \
	        --benchmark_out=build/$$program.json --benchmark_out_format=json || exit $$?; \
	done

# The references of results/references/, resumable: half a and half b of REFERENCE_SPP samples each.
references: programs
	scripts/references $(REFERENCE_SPP)

format:
	git ls-files '*.h' '*.cpp' | xargs clang-format -i

lint:
	scripts/lint

clean:
	rm -rf build build-debug build-asan
