"""Base of the tests of error messages for bad input.

Bad input gives one message with the file, the place, the value and the allowed values, and an exit status. The program
does not hang or crash. Message and status are the same on 3 ranks. The test programs have the arguments PROGRAM ROOT
MPIEXEC COMMANDS. COMMANDS is commands/commands.cpp, which executes many commands in one process. The first command of
each test is also executed by the program itself."""
import os
import re
import resource
import subprocess
import sys
import unittest

import program
from program import ALONE, TIME_LIMIT, ProgramTest
from many_commands import ManyCommands

PUSH = "seed/push_2d.xml"
FRACTURE = '<ParameterList name="fractures"><ParameterList name="f1"/></ParameterList>'


def replaced(text, *changes):
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


PROCESSES = []


def setUpModule():
    for ranks in (1, 3):
        PROCESSES.append(ManyCommands(sys.argv[4], ranks))
        unittest.addModuleCleanup(PROCESSES[-1].close)


class BadInput(ProgramTest):
    def refuse(self, words, *arguments, status=1, any_point=False):
        """Returns the message of `sprekk ARGUMENTS`, after checks that it is one message and contains all words.

        `any_point`: if an expression fails at several points, different numbers of ranks may name different points."""
        answers = [process.call(self.folder, *arguments) for process in PROCESSES]
        if not hasattr(self, "asked"):
            self.asked = True
            answers.append((status, *self.call(*arguments, expect=status)))
        err = answers[0][2]
        hidden = (lambda text: re.sub(r"(is \S+ at )?\([-+.\de]+(, [-+.\de]+)+\)", "", text)) if any_point else str
        for answer in answers:
            self.assertEqual((answer[0], hidden(answer[2])), (status, hidden(err)), arguments)
            log = r"(sprekk \S+: .* on \d ranks?\n|\Z)" if arguments[0] == "run" else r"\Z"
            self.assertRegex(answer[1], r"\A" + log, arguments)
        self.assertEqual(err.count("sprekk: "), 1, err)
        self.assertTrue(err.startswith("sprekk: "), err)
        for word in words:
            self.assertIn(word, err)
        for odd in (".;", "std::", "exception", "1 values", "-nan", "; Did"):
            self.assertNotIn(odd, err)
        return err

    def scene_with(self, *changes, name=PUSH):
        path = self.folder / "scene.xml"
        path.write_text(replaced(self.scene(name).read_text(), *changes))
        return path.name

    def limited(self, *arguments, memory, seconds=TIME_LIMIT):
        """Runs a command on one rank with a limit of the address space in bytes."""
        return subprocess.run(["timeout", str(seconds), program.PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, env={**os.environ, **ALONE},
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory)))

    def refuse_set(self, words, *overrides, any_point=False):
        sets = [word for override in overrides for word in ("--set", override)]
        return self.refuse([PUSH, *words], "check", self.scene(PUSH), *sets, any_point=any_point)

    def refuse_mesh(self, words, content, fractures=FRACTURE, options=()):
        """Checks the message of a scene with a mesh file of this content (text, bytes, or None for no file)."""
        text = self.scene(PUSH).read_text()
        begin, end = text.index('  <ParameterList name="Mesh">'), text.index('  <ParameterList name="Materials">')
        text = (text[:begin] + '<ParameterList name="Mesh file"><Parameter name="path" type="string" value="a.msh"/>'
                + fractures + "</ParameterList>\n" + text[end:])
        (self.folder / "scene.xml").write_text(text.replace('name="fracture"', 'name="f1"'))
        path = self.folder / "a.msh"
        if isinstance(content, str):
            content = content.encode()
        if content is not None:
            path.write_bytes(content)
        return self.refuse(["scene.xml: ", *words], "check", "scene.xml", *options)
