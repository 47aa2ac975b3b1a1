# Installs everything except the programs and the library of the nodes, which their own CMakeLists.txt install.
# ROS packages find the package as `organ_collision` (catkin's configuration). Programs without ROS
# find the first three layers as `organ_collision_core`.
include(CMakePackageConfigHelpers)
set(CORE_CMAKE_DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}/cmake/organ_collision_core)

set(core organ_collision_geometry organ_collision_picking organ_collision_query)
install(TARGETS ${core} EXPORT organ_collision_core
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(EXPORT organ_collision_core NAMESPACE organ_collision::
  FILE organ_collision_coreTargets.cmake DESTINATION ${CORE_CMAKE_DESTINATION})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/organ_collision_coreConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES cmake/organ_collision_coreConfig.cmake
  ${PROJECT_BINARY_DIR}/organ_collision_coreConfigVersion.cmake
  DESTINATION ${CORE_CMAKE_DESTINATION})
install(DIRECTORY include/organ_collision/
  DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION} FILES_MATCHING PATTERN "*.hpp")

install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY config launch urdf DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}
  PATTERN "*.py" EXCLUDE)
install(DIRECTORY examples DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}
  FILES_MATCHING PATTERN "*.launch" PATTERN "*.yaml" PATTERN "*.obj")
# Compiled where the simulators are, from copies of these folders.
install(DIRECTORY examples/ambf examples/sofa DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/examples
  USE_SOURCE_PERMISSIONS PATTERN "build" EXCLUDE)
install(PROGRAMS examples/ask.py examples/ask_many.py examples/crtk_hand.py
  examples/grasper.py examples/guarded_arm.py examples/lower_until_touch.py
  examples/numpy_simulator.py examples/obey_guard.py examples/own_mesh.py examples/plan_grasper.py examples/sculpt.py
  examples/simulator.py scripts/demo_report.py scripts/organ_mesh_adapter scripts/plot.py scripts/pose_adapter.py scripts/trial_report.py scripts/view.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
# plan_grasper.py and grasper.py import these from their own folder.
install(FILES examples/grasper_kinematics.py examples/rrt_connect.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
