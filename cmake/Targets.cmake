# Installed libraries and programs find our libraries in their own folder or the one above it, so the
# prefix may be moved.
set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/..")

# Finds errors that tests cannot see: wrong use of memory and undefined behaviour, or data that several
# threads share. `./run_tests --sanitize` sets it. The libraries of others stay as they are; the files in
# test/sanitizers list what is known of them.
set(ORGAN_COLLISION_SANITIZE "" CACHE STRING "A sanitizer for all targets of the package: address, thread, fuzzer or none")
set_property(CACHE ORGAN_COLLISION_SANITIZE PROPERTY STRINGS "" address thread fuzzer)
if(ORGAN_COLLISION_SANITIZE STREQUAL fuzzer)
  # What run_fuzz builds with clang. The code also counts its branches, for libFuzzer. Alignment is not checked,
  # because roscpp reads numbers at any address.
  set(checks fuzzer-no-link,address,undefined,float-cast-overflow)
  add_compile_options(-fsanitize=${checks} -fno-sanitize=alignment -fno-sanitize-recover=all
                      -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${checks})
elseif(ORGAN_COLLISION_SANITIZE)
  set(sanitizers ${ORGAN_COLLISION_SANITIZE})
  if(sanitizers STREQUAL "address")
    set(sanitizers address,undefined)
    add_compile_options(-O1)  # With -O3, GCC needs three times as long.
  endif()
  # In code with checks in it, GCC 12 takes values for uninitialized that are not.
  add_compile_options(-fsanitize=${sanitizers} -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g1
                      -Wno-maybe-uninitialized -Wno-uninitialized)
  # Inline functions of headers are in the libraries of others, too, without checks. Ours must call their own.
  add_link_options(-fsanitize=${sanitizers} -Wl,-Bsymbolic-functions)
endif()

# Other compilers and libraries than ours may warn of more, so only `./run_tests --strict` takes warnings for errors.
option(ORGAN_COLLISION_STRICT "Take the compiler's warnings for errors" OFF)

# With -DCMAKE_UNITY_BUILD=ON, so many sources of a library are compiled as one: two cores are still kept busy, and the
# headers are read less often.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 6)

# organ_collision_target(TARGET): sets the warnings that every target of the package is built with.
function(organ_collision_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic $<$<BOOL:${ORGAN_COLLISION_STRICT}>:-Werror>)
endfunction()

# organ_collision_layer(NAME [STATIC] SOURCES...): a library of the package, organ_collision_NAME. The
# headers in include/ are installed. Those beside the sources are not; they are included by their
# path from src/.
function(organ_collision_layer name)
  add_library(organ_collision_${name} ${ARGN})
  add_library(organ_collision::${name} ALIAS organ_collision_${name})
  # The binary interface may change with each minor version. Static libraries ignore these numbers.
  set_target_properties(organ_collision_${name} PROPERTIES EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(organ_collision_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
    $<INSTALL_INTERFACE:include>)
  set_target_properties(organ_collision_${name} PROPERTIES DEFINE_SYMBOL "")
  organ_collision_target(organ_collision_${name})
endfunction()

# organ_collision_program(NAME SOURCE LIBRARIES...): a program that is installed.
function(organ_collision_program name source)
  add_executable(${name} ${source})
  target_link_libraries(${name} -Wl,--as-needed ${ARGN})
  organ_collision_target(${name})
  install(TARGETS ${name} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

# organ_collision_nodelet(NAME SOURCE LIBRARIES...): a library that a nodelet manager loads by its name.
function(organ_collision_nodelet name source)
  add_library(${name} SHARED ${source})
  target_link_libraries(${name} ${ARGN} ${nodelet_LIBRARIES})
  organ_collision_target(${name})
  install(TARGETS ${name} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()
