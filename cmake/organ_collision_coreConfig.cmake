# find_package(organ_collision_core): the layers without ROS, as organ_collision::geometry,
# organ_collision::picking and organ_collision::query. Each links the layers before it.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/organ_collision_coreTargets.cmake)
