#!/usr/bin/python3
"""The module's names are there, and whoever wants only messages does not load rospy."""

import subprocess
import sys
import unittest

import organ_collision


class PackageTest(unittest.TestCase):

    def test_all_names_are_there(self):
        names = [name for name in dir(organ_collision) if not name.startswith('_')]
        self.assertLessEqual({'Organ', 'Queries', 'contact_table', 'read_mesh', 'organ_mesh'}, set(names))
        for name in names:
            self.assertTrue(callable(getattr(organ_collision, name)) or name in sys.modules
                            or 'organ_collision.' + name in sys.modules, name)

    def test_an_unknown_name_is_an_attribute_error(self):
        with self.assertRaisesRegex(AttributeError, "'organ_collision' has no attribute 'organ_mehs'"):
            organ_collision.organ_mehs

    def test_messages_load_without_rospy(self):
        program = ('import sys; from organ_collision.msg import OrganMesh;'
                   'from organ_collision.srv import QueryCollision;'
                   'assert not {"rospy", "meshio"} & set(sys.modules)')
        subprocess.check_call([sys.executable, '-c', program])


if __name__ == '__main__':
    unittest.main(verbosity=2)
