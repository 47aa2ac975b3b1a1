"""What the tests that talk to a running node share.

node_client      the node's topics, services, TF and /diagnostics, as a user sees them
processes        nodes, launch files and ROS masters that a test starts and stops itself
contact_case     test cases: the deepest contact is as deep as expected; no answer breaks the contract
tool_case        test cases: tools that move by TF, step by step, also by a simulator's clock
tool_over_sheet  the scene of the tests of motion: a tool straight above a sheet
scenes           meshes and poses
foreign_meshes   meshes in other packages' messages
launch_case      test case: launch files of the package
"""
