#!/usr/bin/python3
"""Writes those inputs in corpus/ that are messages: small and legal ones, and a few that are broken. Fuzzing begins with
the inputs in corpus/. The other ones are kept by hand.

Usage: make_corpus.py [--check]
Run it in the environment of the devel space. --check writes nothing; the exit code is 1 if a file is not as this
script would write it. Files whose names begin with "found_" are findings of the past, which are kept by hand, too.
"""

import argparse
import io
import pathlib
import struct
import sys

import genpy
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, TransformStamped, Vector3
from organ_collision.msg import LinkMotion, OrganMesh, OrganVertices, ToolMotion
from organ_collision.srv import QueryCollisionBatchRequest, QueryCollisionRequest
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

FOLDER = pathlib.Path(__file__).resolve().parent / 'corpus'

SHEET = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]
SHEET_FACES = [0, 1, 2, 0, 2, 3]
SOLID = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]
SOLID_FACES = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]


def wire(message):
    """A message as roscpp gets it, after its size in two bytes."""
    data = io.BytesIO()
    message.serialize(data)
    return struct.pack('<H', len(data.getvalue())) + data.getvalue()


def record(kind, message=None):
    return bytes([kind]) + (wire(message) if message else b'')


def header(seconds=1, frame='world'):
    return Header(stamp=genpy.Time(seconds), frame_id=frame)


def mesh(vertices=SHEET, faces=SHEET_FACES, topology=1, seconds=1, organ='liver'):
    return OrganMesh(header(seconds), organ, topology, vertices, faces)


def vertices(height, seconds, organ='liver'):
    return OrganVertices(header(seconds), organ, 1, [c + height for c in SHEET])


def transform(child, xyz, seconds=1, parent='world', turn=(0, 0, 0, 1)):
    message = TransformStamped(header=header(seconds, parent), child_frame_id=child)
    message.transform.translation = Vector3(*xyz)
    message.transform.rotation = Quaternion(*turn)
    return message


def pose(xyz, seconds=1, frame='world', turn=(0, 0, 0, 1)):
    return PoseStamped(header(seconds, frame), Pose(Point(*xyz), Quaternion(*turn)))


def hook(height, seconds):
    return TFMessage([transform('hook_trocar', (0, 0, 1), seconds), transform('hook_tip', (0.1, 0.2, height), seconds),
                      transform('arm/wrist', (0.3, 0.2, height), seconds),
                      transform('arm/jaw', (0.2, 0.2, height), seconds, turn=(0, 0.6, 0, 0.8))])


def motion(end=-0.3, radius=0.01):
    return ToolMotion(Point(0, 0, 1), Point(0.1, 0.2, 0.3), Point(0, 0, 1), Point(0.1, 0.2, end), radius)


def link_motion(end=-0.3):
    return LinkMotion(*[[Pose(Point(0.1, 0.2, z), Quaternion(0, 0, 0, 1))] * 2 for z in (0.3, end)])


def query_requests():
    ask = lambda **more: QueryCollisionRequest(header=header(0, 'liver_frame'), organ='liver', **more)
    batch = lambda **more: QueryCollisionBatchRequest(header=header(0, 'liver_frame'), organ='liver', **more)
    return {'static': record(0, ask(motion=motion(), mode=0)),
            'swept': record(0, ask(motion=motion(), mode=1, organ_rests=True, regions=True)),
            'clearance': record(0, ask(motion=motion(0.2), mode=1, margin=0.5, clearance=True, max_near=5)),
            'placement': record(0, ask(motion=motion(), mode=0, placement=True)),
            'paper': record(0, ask(motion=motion(), mode=3)),
            'naive': record(0, ask(motion=motion(), mode=4)),
            'tool': record(0, ask(tool='hook', mode=1)),
            'links': record(0, ask(tool='grasper', mode=1, link_motion=link_motion())),
            'both': record(0, ask(tool='hook', mode=1, motion=motion(), link_motion=link_motion())),
            'unknown_organ': record(0, QueryCollisionRequest(header=header(), organ='heart', motion=motion())),
            'not_finite': record(0, ask(motion=motion(float('inf')), mode=1)),
            'batch': record(1, batch(motions=[motion(), motion(0.2), motion(radius=0)], mode=1)),
            'batch_of_tool': record(1, batch(tool='probe', motions=[motion(radius=0)] * 3, mode=1,
                                             stop_at_first_contact=True)),
            'batch_of_links': record(1, batch(tool='grasper', link_motions=[link_motion()] * 2, mode=1, clearance=True,
                                              placement=True, margin=0.1)),
            'large_batch': record(1, batch(motions=[motion()] * 51, mode=0))}


def node_messages():
    tick, later, reset, sheet = record(5), record(6) + b'\x40', record(7), record(0, mesh())
    huge, place = bytearray(sheet), len(sheet) - 4 * len(SHEET_FACES) - 4 - 4 * len(SHEET) - 4
    huge[place:place + 4] = struct.pack('<I', 0x40000002)
    late = OrganMesh(Header(stamp=genpy.Time(0xffffffff, 999999999), frame_id='world'), 'liver', 1, SHEET, SHEET_FACES)
    return {'touch': sheet + record(3, TFMessage([transform('hook_trocar', (0, 0, 1), 0)]))
            + record(4, pose((0.1, 0.2, 0.3), 1)) + record(1, vertices(0.1, 2)) + record(4, pose((0.1, 0.2, -0.3), 3)),
            'links': record(2, hook(0.3, 1)) + record(2, hook(-0.3, 2)) + sheet + record(1, vertices(0.0, 2)) + tick,
            'without_tf': sheet + tick + reset,
            'jump': sheet + record(2, hook(0.3, 1)) + later + record(1, vertices(0.0, 2)) + record(6) + b'\x05' + tick,
            'removed': record(2, hook(-0.3, 1)) + sheet + record(0, mesh([], [])) + tick + record(1, vertices(0.1, 2)),
            'solid': record(0, mesh(SOLID, SOLID_FACES)) + record(3, hook(0.1, 0)) + tick,
            'new_topology': sheet + record(0, mesh(SOLID, SOLID_FACES, 2)),
            'wrong_index': sheet + record(0, mesh(faces=[0, 1, 4])),
            'not_finite': record(0, mesh([float('nan')] + SHEET[1:])),
            'far': record(0, mesh([3e38] + SHEET[1:])) + record(8, pose((1e300, 0, 0))),
            'huge_array': bytes(huge),
            'late_mesh': record(0, late),
            'late_transform': sheet + record(2, hook(0.3, 0xffffffff)) + record(2, hook(0.3, 1)),
            'stylus': sheet + record(8, pose((0, 0, 0.1), 1, 'base')) + record(9, pose((1, 0, 0))) + record(
                3, TFMessage([transform('stylus_trocar', (0, 0, 1), 0)])) + record(8, pose((0, 0, 0.2), 2, 'base')),
            'loop': sheet + record(2, TFMessage([transform('hook_tip', (1, 0, 0), 1, 'hook_trocar'),
                                                 transform('hook_trocar', (1, 0, 0), 1, 'hook_tip')])),
            'own_parent': record(2, TFMessage([transform('world', (1, 0, 0))])),
            'no_rotation': record(2, TFMessage([transform('hook_tip', (1, 0, 0), turn=(0, 0, 0, 0))]))}


def haptic_proxy():
    trocar = record(2, TFMessage([transform('stylus_trocar', (0, 0, 1))]))
    hand = lambda height, seconds: record(3, pose((0.1, 0.2, height), seconds))
    scene = record(0, mesh()) + trocar
    return {'press': b'\0' + scene + b''.join(hand(0.03 - 0.02 * i, 1 + i) for i in range(4)),
            'free': b'\1' + scene + b''.join(hand(0.03 - 0.02 * i, 1 + i) for i in range(4)),
            'organ_moves': b'\0' + scene + hand(0.05, 1) + record(1, vertices(0.06, 2)) + hand(0.05, 3),
            'jump': b'\0' + scene + hand(0.5, 1) + hand(-0.5, 2),
            'solid': b'\0' + record(0, mesh(SOLID, SOLID_FACES)) + trocar + hand(0.5, 1) + hand(0.1, 2),
            'no_organ': b'\0' + trocar + hand(0.1, 1)}


CORPORA = [haptic_proxy, node_messages, query_requests]


def files():
    """The content of each file by its path."""
    return {FOLDER / corpus.__name__ / name: content for corpus in CORPORA for name, content in corpus().items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--check', action='store_true', help='write nothing, and compare')
    if not parser.parse_args().check:
        for path, content in files().items():
            path.write_bytes(content)
        return 0
    expected = files()
    present = {path: path.read_bytes() for corpus in CORPORA for path in (FOLDER / corpus.__name__).iterdir()
               if not path.name.startswith('found_')}
    wrong = sorted(path for path in {**present, **expected} if present.get(path) != expected.get(path))
    for path in wrong:
        print('%s: is not what make_corpus.py writes; run it without --check' % path)
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
