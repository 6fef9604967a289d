"""The Debian packages that cpack makes of this build: names, sizes, files, dependencies; the unpacked program runs."""

import ast
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])
PROGRAM = pathlib.Path(os.environ["SAMARA_PROGRAM"])
BUILD = PROGRAM.parent

LARGEST_SUM = 10e6  # bytes that a user downloads for all packages
NAMES = {"samara": None, "libsamara-dev": None, "python3-samara": "all"}  # None: architecture of this machine
BASELINE = "share/samara/inputs/lee2002/baseline.yaml"


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def owner(path):
    """Names of the installed packages that have a file."""
    path = pathlib.Path(path).resolve()
    places = [path] + ([path.relative_to("/usr")] if path.is_relative_to("/usr") else [])
    for place in places:
        done = subprocess.run(["dpkg", "-S", pathlib.Path("/") / place], capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return {word.strip().split(":")[0] for word in done.stdout.rsplit(": ", 1)[0].split(",")}
    raise AssertionError(f"no package has {path}")


def is_binary(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="samara packages ")
        cls.folder = pathlib.Path(cls.temporary.name)
        # Little compression takes little time; scripts/package makes smaller files.
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "made", cwd=cls.folder,
            env=dict(os.environ, DPKG_DEB_COMPRESSOR_LEVEL="1"))
        cls.files = sorted((cls.folder / "made").glob("*.deb"))
        cls.fields, cls.trees = {}, {}
        for file in cls.files:
            lines = re.sub(r"\n ", " ", run("dpkg-deb", "-f", file)).splitlines()
            fields = dict(line.split(": ", 1) for line in lines if line)
            name = fields["Package"]
            cls.fields[name] = fields
            cls.trees[name] = cls.folder / "each" / name
            for tree in (cls.trees[name], cls.folder / "root"):
                tree.mkdir(parents=True, exist_ok=True)
                run("dpkg-deb", "-x", file, tree)
        cls.prefix = cls.folder / "root/usr"

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def contents(self, name):
        return sorted(path for path in self.trees[name].rglob("*") if not path.is_dir() or path.is_symlink())

    def depends(self, name, field="Depends"):
        """Names of the packages, without versions; of alternatives all."""
        return {word.split("(")[0].split(":")[0].strip() for word in re.split(r"[,|]", self.fields[name][field])}

    def installed(self, name):
        """Paths under /usr."""
        return {str(path.relative_to(self.trees[name] / "usr")) for path in self.contents(name)}

    def binaries(self):
        found = [path for name in NAMES for path in self.contents(name) if not path.is_symlink() and is_binary(path)]
        self.assertEqual(len(found), 4)  # program, its launcher and helper, library
        return found

    def test_names_versions_and_architectures(self):
        version = re.search(r"(?m)^ *VERSION (\S+)$", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
        machine = run("dpkg", "--print-architecture").strip()
        wanted = sorted(f"{name}_{version}_{kind or machine}.deb" for name, kind in NAMES.items())
        self.assertEqual([file.name for file in self.files], wanted)
        for fields in self.fields.values():
            self.assertEqual(fields["Version"], version)
            self.assertRegex(fields["Maintainer"], r"^\S.* <\S+@\S+>$")
            self.assertRegex(fields["Description"], r"^rotor dynamics of ")

    def test_sizes(self):
        self.assertLess(sum(file.stat().st_size for file in self.files), LARGEST_SUM)
        for name, fields in self.fields.items():
            # Debian counts files in steps of 1 KiB, and 1 KiB for each folder and link.
            kib = sum(-(-path.lstat().st_size // 1024) for path in self.contents(name) if not path.is_symlink())
            others = sum(path.is_symlink() or path.is_dir() for path in self.trees[name].rglob("*"))
            self.assertAlmostEqual(int(fields["Installed-Size"]), kib + others, delta=2, msg=name)
        for path in self.binaries():
            self.assertNotIn(".symtab", run("readelf", "-SW", path), path)

    def test_files(self):
        program = self.installed("samara")
        wanted = {"bin/samara", "bin/samara-program", "bin/samara-controller-host", "share/bash-completion/completions/samara",
                  "share/doc/samara/copyright", "share/doc/samara/changelog.gz"}
        for folder in ("inputs", "templates"):
            wanted |= {f"share/samara/{path.relative_to(SOURCE)}" for path in (SOURCE / folder).rglob("*.yaml")}
        self.assertEqual(wanted - program, set())
        self.assertEqual("share/man/man1/samara.1.gz" in program, (SOURCE / "docs/samara.1").exists())
        library = self.installed("libsamara-dev")
        wanted = {"lib/libsamara.so", "lib/cmake/Samara/SamaraConfig.cmake", "lib/cmake/Samara/SamaraTargets.cmake",
                  "include/samara/base/version.hpp", "share/doc/libsamara-dev/examples/cpp/beam.cpp"}
        wanted |= {str(path.relative_to(SOURCE)) for path in (SOURCE / "include").rglob("*.hpp")}
        self.assertEqual(wanted - library, set())
        self.assertTrue((self.trees["libsamara-dev"] / "usr/lib/libsamara.so").resolve().is_file())
        package = {path for path in self.installed("python3-samara") if not path.startswith("share/doc/")}
        self.assertEqual(package, {f"lib/python3/dist-packages/{path.relative_to(SOURCE / 'python')}"
                                   for path in (SOURCE / "python/samara").rglob("*")
                                   if path.is_file() and "__pycache__" not in path.parts})
        licences = (self.trees["python3-samara"] / "usr/share/doc/python3-samara/copyright").read_text(encoding="utf-8")
        for path in [SOURCE / "LICENSE", *(SOURCE / "report/licences").glob("*.txt")]:
            self.assertIn(path.read_text(encoding="utf-8").strip(), licences)
        owned = [path for name in NAMES for path in self.installed(name)]
        self.assertEqual(len(owned), len(set(owned)), "a file in two packages")

    def test_no_file_names_the_tree_of_the_build(self):
        for name in NAMES:
            for path in self.contents(name):
                if path.is_symlink():
                    self.assertFalse(os.path.isabs(os.readlink(path)), path)
                    continue
                # Compiled files name sources, in PETSc's messages of errors.
                for folder in [BUILD] if is_binary(path) else [BUILD, SOURCE]:
                    self.assertFalse(f"{folder}/".encode() in path.read_bytes(), f"{path} names {folder}")
        for path in self.binaries():
            self.assertNotRegex(run("readelf", "-dW", path), r"R(UN)?PATH", path)

    def test_dependencies_have_the_shared_libraries(self):
        for name in ("samara", "libsamara-dev"):
            depends = self.depends(name)
            for pattern in (r"libpetsc-real\d\S*", r"libslepc-real\d\S*", r"libhdf5-openmpi-\d\S*", r"libopenmpi\d+"):
                self.assertTrue(any(re.fullmatch(pattern, word) for word in depends), f"{name}: {pattern}: {depends}")
        for path in self.binaries():
            name = path.relative_to(self.folder / "each").parts[0]
            needed = set(re.findall(r"NEEDED.*\[(.*)\]", run("readelf", "-dW", path)))
            self.assertGreater(len(needed), 0)
            found = dict(re.findall(r"(\S+) => (/\S+)", run("ldd", path)))
            for library in needed:
                if library in ("libblas.so.3", "liblapack.so.3"):  # alternatives
                    self.assertIn(library, self.depends(name))
                else:
                    self.assertTrue(owner(found[library]) & self.depends(name), f"{name}: {library}")

    def test_dependencies_have_what_the_package_of_cmake_finds(self):
        text = (self.prefix / "lib/cmake/Samara/SamaraConfig.cmake").read_text(encoding="utf-8")
        depends = self.depends("libsamara-dev")
        for module in re.findall(r"pkg_check_modules\(\S+ .*IMPORTED_TARGET (\w+)", text):
            folder = run("pkg-config", "--variable=pcfiledir", module).strip()
            self.assertTrue(owner(f"{folder}/{module}.pc") & depends, module)
        for package in re.findall(r"find_dependency\((\w+)", text):
            self.assertIn({"PkgConfig": "pkg-config", "Eigen3": "libeigen3-dev", "MPI": "libopenmpi-dev"}[package], depends)

    def test_dependencies_have_what_the_python_package_imports(self):
        names = {"h5netcdf"}  # by xarray, on demand
        for path in (self.prefix / "lib/python3/dist-packages/samara").glob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Import):
                    names |= {alias.name.split(".")[0] for alias in node.names}
                elif isinstance(node, ast.ImportFrom) and node.level == 0:
                    names.add(node.module.split(".")[0])
        names -= sys.stdlib_module_names
        self.assertLessEqual({"xarray", "matplotlib", "numpy", "yaml"}, names)
        depends = self.depends("python3-samara")
        for name in list(depends):  # some packages have their files in one that they depend on
            words = run("dpkg-query", "-W", "-f", "${Depends}", name)
            depends |= {word.split("(")[0].strip() for word in re.split(r"[,|]", words) if word.strip().startswith(name)}
        for name in names:
            self.assertTrue(owner(importlib.util.find_spec(name).origin) & depends, name)

    def test_the_unpacked_program_runs_the_first_command(self):
        place = self.folder / "work"
        place.mkdir()
        program = self.prefix / "bin/samara"
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(place), "LANG": "C.UTF-8", "OPENBLAS_NUM_THREADS": "1",
                       "SAMARA_PYTHON": sys.executable,
                       "PYTHONPATH": str(self.prefix / "lib/python3/dist-packages")}
        unpacked = run(program, "floquet", self.prefix / BASELINE, "-o", "r.h5", cwd=place, env=environment)
        built = run(PROGRAM, "floquet", SOURCE / "inputs/lee2002/baseline.yaml", "-o", "b.h5", cwd=place, env=environment)
        self.assertIn("1st tower fore-aft", unpacked)
        self.assertEqual(unpacked.replace("r.h5", "b.h5"), built)
        run(program, "new", "three-bladed", "x", cwd=place, env=environment)
        run(program, "check", "x.yaml", cwd=place, env=environment)
        self.assertEqual(run(program, "plot", "r.h5", cwd=place, env=environment),
                         "picture: r_multipliers.svg\npicture: r_spanwise.svg\n")
        where = run(sys.executable, "-c", "import samara; print(samara.__file__)", cwd=place, env=environment).strip()
        self.assertTrue(pathlib.Path(where).is_relative_to(self.prefix), where)


if __name__ == "__main__":
    unittest.main()
