# SPDX-License-Identifier: MIT
# Installation: programs in bin/, and in share/rtrays/ the files that they read at run time
# (renderer/base/resources.h). The prefix may be moved afterwards.
include(GNUInstallDirs)
set(RTRAYS_SHARE ${CMAKE_INSTALL_DATADIR}/rtrays)

install(TARGETS rtrays-render RUNTIME)
if(RTRAYS_TEXTURES)
    # The program looks for its image module in its own folder.
    install(TARGETS rtrays_images LIBRARY DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(RTRAYS_BUILD_REFERENCE)
    install(TARGETS rtrays-reference RUNTIME)
    if(RTRAYS_BUILD_EXPERIMENTS)
        install(TARGETS rtrays-experiment RUNTIME)
    endif()
endif()
if(TARGET rtrays-mpi)
    install(TARGETS rtrays-mpi RUNTIME)
endif()
install(DIRECTORY scenes DESTINATION ${RTRAYS_SHARE} USE_SOURCE_PERMISSIONS)
install(DIRECTORY scripts DESTINATION ${RTRAYS_SHARE} USE_SOURCE_PERMISSIONS
        PATTERN "test_*.py" EXCLUDE PATTERN testing.py EXCLUDE PATTERN lint EXCLUDE
        PATTERN __pycache__ EXCLUDE)
install(DIRECTORY experiments DESTINATION ${RTRAYS_SHARE} FILES_MATCHING PATTERN "*.json"
        PATTERN harness EXCLUDE)
install(DIRECTORY results/references results/baselines DESTINATION ${RTRAYS_SHARE}/results)
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs PATTERN "*.py" EXCLUDE)
