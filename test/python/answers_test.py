#!/usr/bin/python3
"""Tables have all fields of their messages, with their values; other statuses than OK are exceptions. The module's names
are there, and whoever wants only messages does not load rospy."""

import re
import subprocess
import sys
import unittest

from geometry_msgs.msg import Point, Vector3
import numpy as np
import rospy

import organ_collision
from organ_collision import CollisionError, clearance_record, contact_table, contacts_of_all, crossing_table, near_table
from organ_collision.msg import Clearance, Contact, ContactArray, Crossing, ToolPlacement


def contact(face):
    return Contact(face=face, vertices=[face, 8, 9], link=-1, fraction=0.25, point=Point(1, 2, face),
                   normal=Vector3(0, 0.6, 0.8), barycentric=[0.2, 0.3, 0.5], shaft=0.75, depth=-0.001, behind=face == 4,
                   on_organ=Point(4, 5, 6), on_tool=Point(5, 6, 7), touching=True, since=rospy.Time(3, 500000000))


def crossing(direction):
    return Crossing(face=7, vertices=[5, 6, 8], barycentric=[0.5, 0.2, 0.3], shaft=0.75, point=Point(4, 5, 6),
                    direction=direction)


CLEARANCE = Clearance(state=Clearance.KNOWN, margin=0.02, unlimited=True, distance=0.011, least=0.003,
                      least_fraction=0.25, face=4, vertices=[4, 8, 9], barycentric=[0.2, 0.3, 0.5], link=2,
                      on_organ=Point(1, 2, 3), on_tool=Point(4, 5, 6), normal=Vector3(0, 0.6, 0.8),
                      normal_defined=True, unresolved=True, closing_speed=0.25)


class AnswersTest(unittest.TestCase):
    def assert_is_row(self, row, given):
        self.assertEqual(list(row.dtype.names), type(given).__slots__)
        for field in row.dtype.names:
            value = getattr(given, field)
            numbers = [value.x, value.y, value.z] if hasattr(value, 'x') else value
            numbers = value.to_sec() if hasattr(value, 'to_sec') else numbers
            np.testing.assert_array_equal(row[field], numbers, field)

    def test_columns_are_the_fields_of_contact_msg(self):
        answer = ContactArray(contacts=[contact(3), contact(4)], near=[contact(6)])
        for table, messages in ((contact_table(answer), answer.contacts), (near_table(answer), answer.near)):
            self.assertEqual(len(table), len(messages))
            for row, given in zip(table, messages):
                self.assert_is_row(row, given)

    def test_columns_are_the_fields_of_crossing_msg(self):
        given = [crossing(1), crossing(-1)]
        table = crossing_table(ContactArray(placement=ToolPlacement(crossings=given)))
        self.assertEqual((len(table), table.point.shape, table.direction.tolist()), (2, (2, 3), [1, -1]))
        for row, message in zip(table, given):
            self.assert_is_row(row, message)

    def test_a_record_has_the_fields_of_clearance_msg(self):
        record = clearance_record(ContactArray(clearance=CLEARANCE))
        self.assert_is_row(record, CLEARANCE)
        self.assertEqual((record.distance, record.on_tool.tolist()), (0.011, [4, 5, 6]))

    def test_without_contacts_the_columns_are_empty(self):
        table = contact_table(ContactArray())
        self.assertEqual((len(table), table.point.shape), (0, (0, 3)))
        self.assertEqual((len(near_table(ContactArray())), len(crossing_table(ContactArray()))), (0, 0))

    def test_one_table_of_the_contacts_of_many_answers(self):
        table = contacts_of_all([ContactArray(contacts=[contact(3), contact(4)]), ContactArray(),
                                 ContactArray(status=ContactArray.INVALID_REQUEST), ContactArray(contacts=[contact(5)])])
        self.assertEqual(table.motion.tolist(), [0, 0, 3])
        self.assertEqual(table.face.tolist(), contact_table(ContactArray(contacts=[contact(3)])).face.tolist()
                         + contact_table(ContactArray(contacts=[contact(4), contact(5)])).face.tolist())
        self.assertEqual(table.point.shape, (3, 3))
        self.assertEqual(contacts_of_all([]).depth.shape, (0,))

    def test_each_status_but_ok_is_an_exception_with_its_name(self):
        definition = ContactArray._full_text.split('# Modes')[0]
        statuses = dict(re.findall(r'^uint8 ([A-Z_]+)=(\d+)', definition, re.M))
        del statuses['OK']
        self.assertGreater(len(statuses), 7)
        for name, number in statuses.items():
            with self.assertRaisesRegex(CollisionError, '^%s: what was wrong$' % name) as raised:
                contact_table(ContactArray(status=int(number), message='what was wrong', contacts=[contact(3)]))
            self.assertEqual(raised.exception.status, int(number))
            for view in (near_table, crossing_table, clearance_record):
                with self.assertRaisesRegex(CollisionError, name):
                    view(ContactArray(status=int(number)))


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
                   'assert "rospy" not in sys.modules')
        subprocess.check_call([sys.executable, '-c', program])


if __name__ == '__main__':
    unittest.main(verbosity=2)
