# SPDX-License-Identifier: MPL-2.0
# Installs the library and builds a project that uses it, by find_package or by add_subdirectory.
# cmake -D HOW=package|subdirectory -D SOURCE=<repository> -D BUILD=<its build> -D WORK=<scratch> -D COMPILER=<c++> -P this
file(REMOVE_RECURSE "${WORK}")
if(HOW STREQUAL "package")
  execute_process(COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/scifi" -D CMAKE_CXX_COMPILER=${COMPILER}
    -D SCIFI_BUILD_TESTS=OFF -D SCIFI_BUILD_EXAMPLES=OFF -D SCIFI_BUILD_PROGRAMS=OFF
    -D CMAKE_INSTALL_PREFIX=${WORK}/prefix COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${CMAKE_COMMAND}" --install "${WORK}/scifi" COMMAND_ERROR_IS_FATAL ANY)
endif()
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/consumer" -B "${WORK}/consumer"
  -D HOW=${HOW} -D SCIFI_SOURCE=${SOURCE} -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_CXX_COMPILER=${COMPILER}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${WORK}/consumer" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${WORK}/consumer/consumer" COMMAND_ERROR_IS_FATAL ANY)
