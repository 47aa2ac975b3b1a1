"""What the tests that talk to a running node share.

node_client      the node's topics, services, TF and /diagnostics, as a user sees them
processes        nodes, launch files and ROS masters that a test starts and stops itself
contact_case     test cases: contacts are those of the oracle; no answer breaks the contract
tool_case        test case: tools that move by TF, step by step
tool_over_sheet  the scene of the tests of motion: a tool straight above a sheet
oracle           the definition of a contact, computed naively
scenes           meshes and poses
foreign_meshes   meshes in other packages' messages
rigid_mesh       the mesh of a robot's link
simulated_clock  a simulator's clock, and a test case that runs by it
launch_case      test case: launch files of the package
robot_log        the joints and poses of a robot, as TF tells them
vectors          arithmetic on tuples of three
"""
