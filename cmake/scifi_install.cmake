# SPDX-License-Identifier: MPL-2.0
# find_package(scifi 0.1) gives scifi::scifi; with COMPONENTS io also scifi::io, with COMPONENTS conditions that and scifi::conditions;
# with COMPONENTS study scifi::study.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_DATADIR}/cmake/scifi")
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME headers)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.hpp")
install(TARGETS scifi EXPORT scifi_targets)
install(EXPORT scifi_targets FILE scifi_targets.cmake NAMESPACE scifi:: DESTINATION "${package_dir}")
if(TARGET scifi_io)
  install(TARGETS scifi_io EXPORT scifi_io_targets)
  install(EXPORT scifi_io_targets FILE scifi_io_targets.cmake NAMESPACE scifi:: DESTINATION "${package_dir}")
endif()
if(TARGET scifi_conditions)
  install(TARGETS scifi_conditions EXPORT scifi_conditions_targets)
  install(EXPORT scifi_conditions_targets FILE scifi_conditions_targets.cmake NAMESPACE scifi:: DESTINATION "${package_dir}")
endif()
if(TARGET scifi_study)
  install(TARGETS scifi_study EXPORT scifi_study_targets)
  install(EXPORT scifi_study_targets FILE scifi_study_targets.cmake NAMESPACE scifi:: DESTINATION "${package_dir}")
endif()
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/scifi-config.cmake.in"
  "${PROJECT_BINARY_DIR}/scifi-config.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/scifi-config-version.cmake"
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES "${PROJECT_BINARY_DIR}/scifi-config.cmake" "${PROJECT_BINARY_DIR}/scifi-config-version.cmake"
  DESTINATION "${package_dir}")

# pkg-config, for builds without CMake; finds its prefix from its own place, so that the tree can be moved.
configure_file("${PROJECT_SOURCE_DIR}/cmake/scifi.pc.in" "${PROJECT_BINARY_DIR}/scifi.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/scifi.pc" DESTINATION "${CMAKE_INSTALL_DATADIR}/pkgconfig")

if(PROJECT_IS_TOP_LEVEL)
  include("${PROJECT_SOURCE_DIR}/packaging/debian.cmake")
endif()
