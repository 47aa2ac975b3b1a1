# find_package(organ_collision_core) defines the layers without ROS: organ_collision::geometry,
# organ_collision::picking and organ_collision::query. Each layer links the layers before it.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
include(${CMAKE_CURRENT_LIST_DIR}/organ_collision_coreTargets.cmake)
