#!/usr/bin/python3
"""Runs the targets of the program fuzz, built with libFuzzer, and prints what came of it as a table. run_fuzz calls it."""

import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

CORPORA = pathlib.Path(__file__).resolve().parent / 'corpus'
LONGEST = 1.0  # [s] of processor time for an input
# [s] After this time, an input hangs. It is long, because other programs may keep the processors busy.
HANGS = 60
MEMORY = 2048  # [MB] for a target
ALLOCATION = 100  # [MB] for one allocation
LARGEST = 4096  # [bytes] of an input
# 16 MB of freed memory are kept to find uses of it. With more, a growth of memory could not be seen.
SANITIZERS = {'ASAN_OPTIONS': 'quarantine_size_mb=16:detect_odr_violation=0',
              'LSAN_OPTIONS': 'suppressions=%s:print_suppressions=0' % CORPORA.with_name('leaks.txt'),
              'UBSAN_OPTIONS': 'print_stacktrace=1'}
HEAD = '| target | inputs | inputs/s | finding |\n|---|---|---|---|'


def last(log, pattern, otherwise):
    found = re.findall(pattern, log)
    return found[-1] if found else otherwise


def processor_time(program, file):
    """[s] What the program, with its target, takes to start and to read one input."""
    process = subprocess.Popen([*program, str(file)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               env={**os.environ, **SANITIZERS})
    usage = os.wait4(process.pid, 0)[2]
    process.returncode = 0
    return usage.ru_utime + usage.ru_stime


def has_slow_input(program, findings):
    """Runs the inputs that took longer than 1 s once more, and keeps those that need so much processor time. The
    others only waited for a processor."""
    for file in findings.glob('slow-unit-*'):
        with tempfile.NamedTemporaryFile() as empty:
            seconds = processor_time(program, file) - processor_time(program, empty.name)
        if seconds <= LONGEST:
            file.unlink()
    return any(findings.glob('slow-unit-*'))


def run(target, options):
    """Runs one target. Returns its row of the table, and whether something was found. New inputs go into a folder of the
    build, not into the corpus."""
    found, findings = options.build / 'found' / target, options.build / 'findings' / target
    for folder in (found, findings):
        folder.mkdir(parents=True, exist_ok=True)
    program = [str(options.devel / 'lib' / 'organ_collision' / 'fuzz'), target]
    command = [*program, '-runs=%d' % options.runs, '-max_total_time=%d' % options.seconds, '-seed=1',
               '-timeout=%d' % HANGS, '-report_slow_units=%d' % LONGEST, '-rss_limit_mb=%d' % MEMORY,
               '-malloc_limit_mb=%d' % ALLOCATION, '-max_len=%d' % LARGEST, '-print_final_stats=1',
               '-artifact_prefix=%s/' % findings, str(found), str(CORPORA / target)]
    start = time.monotonic()
    done = subprocess.run(command, env={**os.environ, **SANITIZERS}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          cwd=str(options.build))
    seconds = time.monotonic() - start
    log = done.stdout.decode(errors='replace')
    (options.build / ('fuzz_%s.log' % target)).write_text(log)
    finding = last(log, r'(?:ERROR|SUMMARY): (.+)', 'exit code %d' % done.returncode) if done.returncode else ''
    if not finding and has_slow_input(program, findings):
        finding = 'slow'
    runs = int(last(log, r'number_of_executed_units: (\d+)', '0'))
    return '| %s | %d | %.0f | %s |' % (target, runs, runs / seconds, finding or 'none'), bool(finding)


def folder(text):
    return pathlib.Path(text).resolve()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--runs', type=int, default=1000000)
    parser.add_argument('--seconds', type=int, default=0)
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('build', type=folder)
    parser.add_argument('devel', type=folder)
    parser.add_argument('target', nargs='*')
    options = parser.parse_args()
    targets = options.target or sorted(corpus.name for corpus in CORPORA.iterdir())
    results = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as threads:
        for done in concurrent.futures.as_completed([threads.submit(run, target, options) for target in targets]):
            results.append(done.result())
            print(results[-1][0], flush=True)
    table = '\n'.join([HEAD] + sorted(row for row, _ in results))
    (options.build / 'fuzz.md').write_text(table + '\n')
    print('\n' + table)
    return 1 if any(has_finding for _, has_finding in results) else 0


if __name__ == '__main__':
    sys.exit(main())
