#!/usr/bin/python3
"""Lowers the tip of a shaft in steps of 1 mm until the shaft touches the organ in an OBJ file.
query_offline answers each step before this program decides on the next one."""

import argparse
import subprocess

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('mesh', nargs='?', default='organ.obj', help='OBJ file in metres (default: organ.obj)')
mesh = parser.parse_args().mesh

program = subprocess.Popen(
    ['rosrun', 'organ_collision', 'query_offline', '--mesh', mesh, '--motions', '-', '--blank-lines'],
    stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)  # 1: each line is sent at once
program.stdout.readline()  # the names of the columns

touched = []
for step in range(100):
    previous, tip = 0.06 - 0.001 * step, 0.06 - 0.001 * (step + 1)
    print('%d,swept,0.01,0.02,0.1,0.01,0.02,%r,0.01,0.02,%r,0.005' % (step, previous, tip), file=program.stdin)
    touched = list(iter(program.stdout.readline, '\n'))  # the lines up to the blank one
    if touched:
        break
program.stdin.close()
if program.wait() != 0:
    raise SystemExit('query_offline failed')
print('step %d touches %d faces' % (step, len(touched)) if touched else 'no step touches')
