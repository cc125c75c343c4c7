# Installs tress, moves the result away (nothing installed may depend on where it was put),
# builds the consumer against it and runs it.
set(work ${BINARY_DIR}/install_test)
file(REMOVE_RECURSE ${work})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${work}/first
                        --component development
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${work}/first ${work}/moved)

file(GLOB_RECURSE exported ${work}/moved/*.cmake)
foreach(file IN LISTS exported)
  file(READ ${file} text)
  foreach(private "${SOURCE_DIR}" "${BINARY_DIR}" "${work}/first" "Eigen3::" "/usr/include")
    string(FIND "${text}" "${private}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} names ${private}")
    endif()
  endforeach()
endforeach()

execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${work}/build
                        -G Ninja -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_COMPILER=${CXX}
                        "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" -DCMAKE_PREFIX_PATH=${work}/moved
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${work}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${work}/build/consumer ${SOURCE_DIR}/scenes/cantilever.toml
                COMMAND_ERROR_IS_FATAL ANY)
