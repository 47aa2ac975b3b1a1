"""Runs of query_offline."""

import subprocess
import time

MOTIONS = 20_000
FEW = 10  # motions of a run that does little but read the mesh


def seconds_of(workspace, folder, motions, jobs):
    start = time.monotonic()
    subprocess.run(workspace.command('query_offline', '--mesh', f'{folder}/organ.obj', '--motions', motions, '--jobs', jobs),
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    return time.monotonic() - start


def offline_rate(workspace, folder, mode, jobs):
    """The motions a second, without the time in which the mesh is read. `folder` has the files of
    Library.write_files(MOTIONS, folder)."""
    few = f'{folder}/few_{mode}.csv'
    with open(f'{folder}/{mode}.csv', encoding='ascii') as motions, open(few, 'w', encoding='ascii') as start:
        for _ in range(FEW):
            start.write(motions.readline())
    reading = seconds_of(workspace, folder, few, jobs)
    return (MOTIONS - FEW) / (seconds_of(workspace, folder, f'{folder}/{mode}.csv', jobs) - reading)
