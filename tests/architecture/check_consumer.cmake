# SPDX-License-Identifier: MPL-2.0
# Builds and runs somebody else's project that uses the library.
# cmake -D HOW=package|subdirectory|fetch|pkg_config|debian|copy -D SOURCE=<repository> -D WORK=<scratch> -D COMPILER=<c++> [-D EIGEN=<include path>] -P this
set(consumer "${CMAKE_CURRENT_LIST_DIR}/consumer")
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")

macro(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endmacro()

set(prefix "${WORK}/prefix")
if(HOW MATCHES "^(package|pkg_config|debian)$")
  run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/scifi" -D CMAKE_CXX_COMPILER=${COMPILER}
    -D SCIFI_BUILD_TESTS=OFF -D SCIFI_BUILD_EXAMPLES=OFF -D SCIFI_BUILD_PROGRAMS=OFF -D CMAKE_INSTALL_PREFIX=${prefix})
  if(HOW STREQUAL "debian")
    get_filename_component(tools "${CMAKE_COMMAND}" DIRECTORY)
    run("${tools}/cpack" -G DEB --config "${WORK}/scifi/CPackConfig.cmake" -B "${WORK}/packages")
    file(GLOB package "${WORK}/packages/libscifi-dev_*_all.deb")
    run(dpkg-deb --extract "${package}" "${WORK}/root")
    set(prefix "${WORK}/root/usr")
  else()
    run("${CMAKE_COMMAND}" --install "${WORK}/scifi")
    # The installed tree works wherever it is moved to.
    file(RENAME "${prefix}" "${WORK}/moved")
    set(prefix "${WORK}/moved")
  endif()
endif()

if(HOW STREQUAL "pkg_config")
  file(COPY "${consumer}/" DESTINATION "${WORK}/consumer")
  set(ENV{PKG_CONFIG_PATH} "${prefix}/share/pkgconfig")
  run(make -C "${WORK}/consumer" CXX=${COMPILER})
elseif(HOW STREQUAL "copy")
  file(COPY "${SOURCE}/include" DESTINATION "${WORK}")
  file(MAKE_DIRECTORY "${WORK}/consumer")
  run("${COMPILER}" -std=c++20 -I "${WORK}/include" -I "${EIGEN}" "${consumer}/consumer.cpp" -o "${WORK}/consumer/consumer")
else()
  if(HOW STREQUAL "debian")
    set(HOW package)
  endif()
  run("${CMAKE_COMMAND}" -S "${consumer}" -B "${WORK}/consumer" -D HOW=${HOW} -D SCIFI_SOURCE=${SOURCE}
    -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${COMPILER})
  run("${CMAKE_COMMAND}" --build "${WORK}/consumer")
endif()
run("${WORK}/consumer/consumer")
