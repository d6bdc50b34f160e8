# SPDX-License-Identifier: MIT
# Tests of the harness, and those that need all programs.
rtrays_test(experiments_test HOST
    SOURCES
        harness/core/contest_test.cpp harness/core/document_test.cpp harness/core/error_parts_test.cpp harness/core/experiment_test.cpp
        harness/core/expression_test.cpp
        harness/core/metrics_test.cpp harness/core/references_test.cpp harness/core/reproduce_test.cpp
        harness/core/statistics_test.cpp
        harness/kinds/convergence_control_test.cpp harness/kinds/curves_description_test.cpp
        harness/kinds/gate_test.cpp harness/kinds/stability_test.cpp harness/kinds/unreferenced_test.cpp
        harness/kinds/throughput_test.cpp
        harness/models/timed_scenes_test.cpp
    LIBRARIES rtrays_experiments)
target_compile_definitions(experiments_test PRIVATE RTRAYS_EXPERIMENTS="${PROJECT_SOURCE_DIR}/experiments")

# The gate: one test for each check of a scene.
foreach(entry cornell_box.bitwise cornell_box.convergence cornell_box.agreement mirror_ring.convergence
              mirror_ring.agreement)
    string(REPLACE "." ";" scene_and_check ${entry})
    list(GET scene_and_check 0 scene)
    list(GET scene_and_check 1 check)
    add_test(NAME gate.${entry}
        COMMAND rtrays-experiment run ${CMAKE_CURRENT_SOURCE_DIR}/gates/gate_${scene}.json --check ${check} --quiet)
    set_tests_properties(gate.${entry} PROPERTIES TIMEOUT 900 COST 30 LABELS gate)
endforeach()

foreach(test program measurements)
    add_test(NAME programs.experiment.${test}
        COMMAND ${RTRAYS_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/harness/${test}_test.py $<TARGET_FILE:rtrays-experiment> -v)
    set_tests_properties(programs.experiment.${test} PROPERTIES TIMEOUT 900 RUN_SERIAL ON)
endforeach()

add_test(NAME scripts
    COMMAND ${RTRAYS_PYTHON} -m unittest discover -s ${PROJECT_SOURCE_DIR}/scripts/rtrays
            -t ${PROJECT_SOURCE_DIR}/scripts -v)
set_tests_properties(scripts PROPERTIES TIMEOUT 600 COST 70)

# Programs and data of an installation that was moved.
add_test(NAME programs.installed
    COMMAND ${RTRAYS_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/harness/install_test.py ${CMAKE_BINARY_DIR})
set_tests_properties(programs.installed PROPERTIES TIMEOUT 600)

# The plan for a machine with a GPU, on this one.
add_test(NAME programs.gpu_run
    COMMAND ${RTRAYS_PYTHON} ${PROJECT_SOURCE_DIR}/scripts/gpu_run ${CMAKE_BINARY_DIR}/gpu_run --tiny --device cpu)
set_tests_properties(programs.gpu_run PROPERTIES TIMEOUT 900 RUN_SERIAL ON)

# The commands and JSON blocks of the documentation.
add_test(NAME docs.commands
    COMMAND ${RTRAYS_PYTHON} ${PROJECT_SOURCE_DIR}/docs/commands_test.py ${CMAKE_BINARY_DIR})
set_tests_properties(docs.commands PROPERTIES TIMEOUT 900 COST 60)

rtrays_test(estimators_test SOURCES harness/estimators_test.cpp LIBRARIES rtrays_experiments)
rtrays_test(analytic_test SOURCES harness/analytic_test.cpp LIBRARIES rtrays_experiments)

# Agreement of renderer and reference on a dozen feature scenes; `make test-full` tests all of them.
add_test(NAME features.agree
    COMMAND rtrays-experiment run ${CMAKE_CURRENT_SOURCE_DIR}/gates/feature_scenes.json
            --out ${CMAKE_BINARY_DIR}/feature_scenes.quick --quiet)
set_tests_properties(features.agree PROPERTIES TIMEOUT 1200 COST 90 LABELS gate)
# Agreement of every algorithm with the reference on a dozen scenes.
add_test(NAME algorithms.agree
    COMMAND rtrays-experiment run ${CMAKE_CURRENT_SOURCE_DIR}/gates/algorithms.json
            --out ${CMAKE_BINARY_DIR}/algorithms.quick --quiet)
set_tests_properties(algorithms.agree PROPERTIES TIMEOUT 1200 COST 200 LABELS gate)

# A dozen stiff and extreme cases; `make stability` runs all of them.
add_test(NAME stability
    COMMAND rtrays-experiment run ${CMAKE_CURRENT_SOURCE_DIR}/robustness/stability.json --profile ci
            --out ${CMAKE_BINARY_DIR}/stability.ci --quiet)
set_tests_properties(stability PROPERTIES TIMEOUT 1200 COST 70 LABELS gate)

# Agreement with Mitsuba 3 and Blender's Cycles on a few scenes, and units; skipped if they are not installed.
add_test(NAME peers.agree COMMAND ${RTRAYS_PYTHON} ${PROJECT_SOURCE_DIR}/scripts/peers --programs ${CMAKE_BINARY_DIR}/bin
         --work ${CMAKE_BINARY_DIR}/peers.quick)
set_tests_properties(peers.agree PROPERTIES TIMEOUT 900 RUN_SERIAL ON SKIP_RETURN_CODE 77 LABELS peers)

add_test(NAME features.are_generated COMMAND ${RTRAYS_PYTHON} ${PROJECT_SOURCE_DIR}/scenes/features/generate --check)
add_test(NAME extreme.are_generated COMMAND ${RTRAYS_PYTHON} ${PROJECT_SOURCE_DIR}/scenes/extreme/generate --check)
add_test(NAME scenes.are_generated COMMAND ${RTRAYS_PYTHON} ${PROJECT_SOURCE_DIR}/scenes/generate --check)
