"""Executes many commands of the program in one process, by commands/commands.cpp."""
import os
import select
import subprocess
import tempfile
from pathlib import Path

from program import ALONE, MPIEXEC, TIME_LIMIT


class ManyCommands:
    def __init__(self, commands, ranks):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = Path(self.scratch.name)
        pipes = {name: [self.folder / f"{name}.{rank}" for rank in range(ranks)] for name in ("in", "status")}
        for path in pipes["in"] + pipes["status"]:
            os.mkfifo(path)
        mpi = [MPIEXEC, "--quiet", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)] if ranks > 1 else []
        self.process = subprocess.Popen([*mpi, commands, self.folder], stdin=subprocess.DEVNULL,
                                        env={**os.environ, **(ALONE if ranks == 1 else {})})
        self.inputs, self.statuses = ([open(os.open(path, os.O_RDWR), "r+b", buffering=0) for path in pipes[name]]
                                      for name in ("in", "status"))

    def call(self, folder, *words):
        """Returns status, standard output and standard error of a command in the folder."""
        line = "".join(f"{word}\t" for word in (folder, *words)) + "\n"
        for pipe in self.inputs:
            pipe.write(line.encode())
        found = {self.status(pipe, line) for pipe in self.statuses}
        assert len(found) == 1, f"{line}: ranks differ in their status, {found}"
        out, err = ("".join((self.folder / f"{name}.{rank}").read_text() for rank in range(len(self.inputs)))
                    for name in ("out", "err"))
        return found.pop(), out, err

    def status(self, pipe, line):
        for _ in range(TIME_LIMIT):
            if select.select([pipe], [], [], 1)[0]:
                return int(pipe.readline())
            assert self.process.poll() is None, f"{line}: the program ended with status {self.process.returncode}"
        raise AssertionError(f"{line}: no answer within {TIME_LIMIT} s")

    def close(self):
        for pipe in self.inputs + self.statuses:
            pipe.close()
        try:
            status = self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = self.process.wait()
        self.scratch.cleanup()
        assert status == 0, f"the process of many commands ended with status {status}"
