"""The program motions_benchmark: CollisionQuery and FCL, without ROS."""

from program import Program


class Library(Program):
    def __init__(self, workspace, faces, tool):
        super().__init__(workspace.command('motions_benchmark', faces, tool))

    def rate(self, engine, threads, seconds):
        """The motions a second of an engine, on so many threads."""
        return self.ask(f'{engine} {threads} {seconds}')['motions_per_second']

    def compare(self):
        """How far FCL's answers are from the library's."""
        return self.ask('compare')

    def write_files(self, motions, folder):
        """Writes the organ, so many motions, and the robot, into a folder."""
        self.ask(f'write {motions} {folder}')
