"""Two hosts in two network namespaces of this machine, joined by a cable. Each has its own address and name."""

import os
import signal
import subprocess
import sys
import tempfile

ADDRESSES = '10.77.0.1', '10.77.0.2'
UNUSED_ADDRESS = '10.77.0.99'
SKIPPED = 77  # exit status
OWN_NAMESPACES = ['--net', '--uts', '--pid', '--mount-proc', '--fork', '--kill-child']
CABLE = ['ip', 'link', 'add', 'left', 'type', 'veth', 'peer', 'name', 'right']
INSIDE = '--inside'


def enter():
    """Runs this program again in namespaces of its own, which end with it. If the system does not permit them, ends
    with SKIPPED."""
    if INSIDE in sys.argv:
        sys.argv.remove(INSIDE)
        os.environ.pop('ROS_HOSTNAME', None)  # It would come before ROS_IP.
        return
    for rights in [], ['--user', '--map-root-user']:
        command = ['unshare', *rights, *OWN_NAMESPACES]
        tried = subprocess.run([*command, *CABLE], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if tried.returncode == 0:
            os.execvp('unshare', [*command, sys.executable, *sys.argv, INSIDE])
    print('skipped: this system permits no network namespaces: ' + tried.stdout)
    sys.exit(SKIPPED)


class Host:
    """`words`: what a command begins with to run on this host."""

    def __init__(self, address, words=()):
        self.address, self.words = address, list(words)

    def run(self, *command):
        subprocess.run([*self.words, *command], check=True)

    def configure(self, device, name):
        self.run('ip', 'link', 'set', 'lo', 'up')
        self.run('ip', 'address', 'add', self.address + '/24', 'dev', device)
        self.run('ip', 'link', 'set', device, 'up')
        self.run('hostname', name)

    def environment(self):
        """The variables that ROS needs on this host. The master is on the first one."""
        return {'ROS_MASTER_URI': 'http://%s:11311' % ADDRESSES[0], 'ROS_IP': self.address}

    def start(self, *command, **changes):
        """Starts a program. `changes`: other values of environment variables; None: not set."""
        variables = {**os.environ, **self.environment(), **changes}
        return Program([*self.words, *command], {k: v for k, v in variables.items() if v is not None})


class Program:
    """A program whose output goes to a file."""

    def __init__(self, command, environment):
        self.file = tempfile.NamedTemporaryFile()
        self.process = subprocess.Popen(command, env=environment, stdout=self.file, stderr=subprocess.STDOUT,
                                        start_new_session=True)

    def output(self):
        """All that it has printed so far."""
        with open(self.file.name, encoding='utf-8') as text:
            return text.read()

    def stop(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
            try:
                self.process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()


def two_hosts():
    """The first one is where this program runs."""
    second = subprocess.Popen(['unshare', '--net', '--uts', 'sleep', 'infinity'])
    enter_second = ['nsenter', '--target', str(second.pid), '--net', '--uts']
    hosts = Host(ADDRESSES[0]), Host(ADDRESSES[1], enter_second)
    subprocess.run(CABLE, check=True)
    while os.readlink('/proc/self/ns/net') == os.readlink('/proc/%d/ns/net' % second.pid):
        pass  # Until unshare has made the other namespace.
    subprocess.run(['ip', 'link', 'set', 'right', 'netns', str(second.pid)], check=True)
    for host, device, name in zip(hosts, ('left', 'right'), ('simulation', 'collision')):
        host.configure(device, name)
    return hosts
