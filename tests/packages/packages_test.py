#!/usr/bin/env python3
"""The packages of `./sprekk package` in a fresh Debian 12, as an ordinary user: packages_test.py ROOT

The Debian 12 is made by debootstrap in a temporary folder and used through chroot, as root."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
PACKAGES = ROOT / "output/packages"
XML = "/usr/lib/sprekk/xml"
MODEL = f"""import sprekk
model = sprekk.Model(sprekk.Scene("{XML}/seed/push_2d.xml"))
model.run()
print(sprekk.__file__, model.time)
"""


def missing():
    if os.geteuid() != 0:
        return "needs root"
    programs = [name for name in ("debootstrap", "unshare", "chroot") if not shutil.which(name)]
    return f"needs {programs[0]}" if programs else None


def mirror():
    """The first one of this machine's Debian packages."""
    etc = Path("/etc/apt")
    for file in (*sorted(etc.glob("sources.list.d/*.sources")), etc / "sources.list"):
        text = file.read_text() if file.exists() else ""
        if found := re.search(r"^(?:URIs:|deb(?: \[.*\])?) *(http\S+)", text, re.MULTILINE):
            return found[1]
    return "http://deb.debian.org/debian"


class Debian:
    """A fresh Debian 12 in a folder."""

    def __init__(self, folder):
        self.folder = folder
        subprocess.run(["debootstrap", "--variant=minbase", "bookworm", folder, mirror()], check=True,
                       stdout=subprocess.DEVNULL)
        copies = {"resolv.conf": "etc", "hosts": "etc", "ssl/certs/ca-certificates.crt": "certificates.crt"}
        for name, to in copies.items():
            if Path("/etc", name).exists():
                shutil.copy(Path("/etc", name), folder / to)
        self.cache = Path(os.environ.get("CCACHE_DIR", Path.home() / ".cache/ccache"))
        self.cache.mkdir(parents=True, exist_ok=True)
        (folder / "ccache").mkdir()
        (folder / "etc/dpkg/dpkg.cfg.d/fast").write_text("force-unsafe-io\n")
        self.call("apt-get update")
        self.call("useradd --create-home user")

    def call(self, command, user="root", expect=0):
        """What a command of bash prints, started in the user's home; its mounts and processes end with it."""
        home = "/root" if user == "root" else f"/home/{user}"
        surroundings = {name: value for name, value in os.environ.items() if re.match("PIP_|.*_proxy$", name)}
        if (self.folder / "certificates.crt").exists():
            surroundings["PIP_CERT"] = "/certificates.crt"  # also those of a proxy of this machine
        surroundings |= {"PATH": "/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin", "HOME": home, "LC_ALL": "C.UTF-8",
                         "DEBIAN_FRONTEND": "noninteractive", "CCACHE_DIR": "/ccache", "CC": "cc", "CXX": "c++"}
        enter = (f"mount --bind {self.cache} {self.folder}/ccache && mount -t sysfs sysfs {self.folder}/sys && "
                 f"exec chroot --userspec={user} {self.folder} bash -c \"$0\"")
        done = subprocess.run(["unshare", "--mount", "--pid", "--fork", f"--mount-proc={self.folder}/proc", "sh", "-c",
                               enter, f"cd {home}; {command}"], env=surroundings, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != expect:
            raise AssertionError(f"{command}\nstatus {done.returncode}, expected {expect}\n{done.stdout[-5000:]}")
        return done.stdout

    def install(self, *names):
        self.call("apt-get install -y " + " ".join(names))

    def put(self, path, to):
        (shutil.copytree if path.is_dir() else shutil.copy)(path, self.folder / to)


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        subprocess.run([ROOT / "sprekk", "package"], check=True)
        cls.scratch = tempfile.TemporaryDirectory(prefix="sprekk-packages-")
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.debian = Debian(Path(cls.scratch.name) / "debian")
        cls.debian.put(PACKAGES, "packages")

    def user(self, command, expect=0):
        return self.debian.call(command, "user", expect)

    def test_1_checksums(self):
        self.debian.call("cd /packages && sha256sum --check --strict SHA256SUMS")
        self.assertEqual(len((PACKAGES / "SHA256SUMS").read_text().splitlines()), 4)

    def test_2_program(self):
        compilers = ("gcc-", "gcc-12-", "g++-", "g++-12-")  # recommended by other packages; not to be installed
        self.debian.install("/packages/sprekk_*.deb", *compilers)
        self.user("for name in gcc g++ c++ cc; do if type $name; then exit 9; fi; done")
        version = re.search(r"project\(Sprekk VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertIn(version, self.user("sprekk --version"))
        self.assertNotIn("./sprekk", self.user("sprekk --help"))
        self.user("sprekk reference --schema | cmp - /usr/lib/sprekk/docs/sprekk.rng")
        self.user(f"sprekk check {XML}/seed/push_2d.xml")
        self.user(f"sprekk run {XML}/seed/push_3d.xml --output one")
        self.user(f"sprekk run {XML}/seed/push_3d.xml --ranks 2 --output two")
        self.assertRegex(self.user("cat two/results.json"), r'"ranks": *2\b')
        self.user("mkdir -p a/b && cd a/b && sprekk plot ../../two && ls ../../two/*.png")
        self.user("sprekk report two")
        self.assertIn("vtkRenderWindow", self.user("cat two/report.html"))  # the 3D view
        self.user(f"sprekk point {XML}/point/cyclic_shear.xml > point.csv && sprekk plot point.csv")
        self.user(f"sprekk mesh {XML}/networks/outcrop_2d.xml -o outcrop.msh")
        self.user("sprekk mesh-info outcrop.msh --fractures traces,fault")
        self.user(f"sprekk run {XML}/networks/outcrop_2d.xml --output outcrop")
        self.user("sprekk export outcrop -o outcrop.geojson")
        self.user(f"sprekk network {XML}/networks/statistics_2d.toml -o drawn && sprekk check drawn.xml")
        for scene in sorted((ROOT / "xml/new").glob("*.xml")):
            self.user(f"sprekk new {scene.stem} {scene.name} && test -s {scene.name}")
        for command in ("test", "build", "perf contact", "fuzz", "package", "docs"):
            self.assertIn("requires the source tree", self.user(f"sprekk {command}", expect=1))

    def test_3_python(self):
        (self.debian.folder / "home/user/model.py").write_text(MODEL)
        self.assertIn("/usr/lib/python3", self.user("python3 model.py"))
        self.assertIn("class Mesh(Section)", self.user("cat /usr/lib/python3*/dist-packages/sprekk/entries.pyi"))
        self.assertEqual(self.user("sprekk python --ranks 2 model.py").count("/usr/lib/python3"), 2)
        network = f"import sprekk; sprekk.Model(sprekk.Scene('{XML}/networks/outcrop_2d.xml'))"
        self.user(f'python3 -c "{network}"')

    def test_4_packages_that_are_missing(self):
        self.debian.call("apt-get remove -y python3-vtk9")
        self.assertEqual(self.user("sprekk plot two", expect=1),
                         "sprekk: plot requires further packages; install them with: sudo apt-get install python3-vtk9\n")

    def test_5_removal(self):
        files = self.debian.call("dpkg -L sprekk").split()
        self.assertIn("/usr/bin/sprekk", files)
        self.debian.call("apt-get remove -y sprekk")
        left = self.debian.call("find / -xdev -name '*sprekk*' -not -path '/packages/*' -not -path '/home/*'")
        self.assertEqual(left, "")
        here = [self.debian.folder / name[1:] for name in files]
        self.assertEqual([str(file) for file in here if file.is_symlink() or file.is_file()], [])

    def test_6_development(self):
        self.debian.install("g++", "cmake", "ninja-build", "/packages/libsprekk-dev_*.deb")
        self.debian.put(ROOT / "tests/embedding/outside", "host")
        self.debian.put(ROOT / "xml/seed/push_2d.xml", "host")
        for file in ("own_unknown.cpp", "grout.hpp", "coupled.cpp", "coupled.hpp", "own_flow.hpp", "reservoir.hpp"):
            self.debian.put(ROOT / "apps/hosts" / file, "host")
        self.debian.put(ROOT / "apps/multigrid/elasticity.cpp", "host")
        self.user("cmake -S /host -B host -G Ninja && ninja -C host my_host")
        self.assertIn("face ", self.user("host/my_host /host/push_2d.xml"))

    def test_7_pip(self):
        """The source archive, without git, with a virtual environment and with Debian's Python."""
        self.debian.call("tar -xf /packages/sprekk-*.tar.gz && mv sprekk-*/ source")
        self.debian.call('. source/apps/launcher/source_tree.sh && apt-get install -y "${packages[@]}" python3-{pip,venv}')
        self.debian.call("python3 -m venv environment && environment/bin/pip install ./source")
        (self.debian.folder / "root/model.py").write_text(MODEL.replace(XML, "/root/source/xml"))
        self.assertIn("/root/environment/", self.debian.call("environment/bin/python model.py"))
        self.debian.call("python3 -m pip install --break-system-packages ./source")
        self.assertIn("/usr/local/lib/python3", self.debian.call("python3 model.py"))
        self.debian.call("python3 -m pip uninstall -y --break-system-packages sprekk")
        self.debian.call("python3 -m pip install --break-system-packages /packages/sprekk-*.whl && python3 model.py")


if __name__ == "__main__":
    if reason := missing():
        print(f"skipped: {reason}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], failfast=True)
