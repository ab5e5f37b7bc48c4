"""Runs a command with its output in LOG; prints status, CPU seconds and peak bytes: cost.py LOG COMMAND...

A process of its own: the peak of a child begins with the memory of the process that starts it."""
import os
import subprocess
import sys

with open(sys.argv[1], "w") as log:
    process = subprocess.Popen(sys.argv[2:], stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
    _, status, used = os.wait4(process.pid, 0)
process.returncode = os.waitstatus_to_exitcode(status)
print(process.returncode, used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss)
