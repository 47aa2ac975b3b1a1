"""What the tests that talk to a running node share.

node_client           the node's topics, services, TF and /diagnostics, as a user sees them
node_starter          nodes that a test starts and stops itself
launched              launch files that a test starts and stops itself
contract              test case: no answer breaks the contract, by check_contacts
contact_case          test case: compares contacts with the oracle
tool_case             test case: tools that move by TF, step by step
tool_over_sheet       the scene of the tests of motion: a tool straight above a sheet
link_case             test case: tools with links
mesh_adapter_case     test case: organ_mesh_adapter
contact_adapter_case  test case: contact_adapter
oracle                the definition of a contact, computed naively
paper_oracle          the faces in the paper's viewing volumes, computed naively
scenes                meshes and poses
foreign_meshes        meshes in other packages' messages
rigid_mesh            the mesh of a robot's link
own_master            a ROS master that a test starts and kills itself
vectors               arithmetic on tuples of three
"""
