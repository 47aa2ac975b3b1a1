#!/usr/bin/python3
"""Tables have all fields of Contact.msg, with their values; other statuses than OK are exceptions."""

import re
import unittest

from geometry_msgs.msg import Point, Vector3
import numpy as np

from organ_collision import CollisionError, contact_table
from organ_collision.msg import Contact, ContactArray


def contact(face):
    return Contact(face=face, vertices=[face, 8, 9], link=2, fraction=0.25, point=Point(1, 2, face),
                   normal=Vector3(0, 0.6, 0.8), barycentric=[0.2, 0.3, 0.5], shaft=0.75, depth=-0.001, behind=face == 4,
                   end_point=Point(4, 5, 6), view_min=0.1, view_max=0.2)


class AnswersTest(unittest.TestCase):

    def test_columns_are_the_fields_of_contact_msg(self):
        table = contact_table(ContactArray(contacts=[contact(3), contact(4)]))
        self.assertEqual(list(table.dtype.names), Contact.__slots__)
        for row, given in zip(table, (contact(3), contact(4))):
            for field in Contact.__slots__:
                value = getattr(given, field)
                numbers = [value.x, value.y, value.z] if hasattr(value, 'x') else value
                np.testing.assert_array_equal(row[field], numbers, field)

    def test_columns_have_a_row_for_each_contact(self):
        table = contact_table(ContactArray(contacts=[contact(3), contact(4), contact(5)]))
        self.assertEqual([column.shape for column in (table, table.depth, table.point, table.vertices)],
                         [(3,), (3,), (3, 3), (3, 3)])
        self.assertEqual(table[table.behind].face.tolist(), [4])

    def test_without_contacts_the_columns_are_empty(self):
        table = contact_table(ContactArray())
        self.assertEqual((len(table), table.point.shape), (0, (0, 3)))

    def test_each_status_but_ok_is_an_exception_with_its_name(self):
        definition = ContactArray._full_text.split('# modes')[0]
        statuses = dict(re.findall(r'^uint8 ([A-Z_]+)=(\d+)', definition, re.M))
        del statuses['OK'], statuses['STATIC']
        self.assertGreater(len(statuses), 7)
        for name, number in statuses.items():
            with self.assertRaisesRegex(CollisionError, '^%s: what was wrong$' % name) as raised:
                contact_table(ContactArray(status=int(number), message='what was wrong', contacts=[contact(3)]))
            self.assertEqual(raised.exception.status, int(number))


if __name__ == '__main__':
    unittest.main(verbosity=2)
