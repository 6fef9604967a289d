"""Faults of disks, machines and users: nothing that was promised is lost, nothing foreign touched."""

import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import LONGEST_RUN, MINIMAL, MPIEXEC, PROGRAM, SOURCE, ProgramTest, wait_until_it_stands  # noqa: E402

COARSE_TURBINE = SOURCE / "inputs/nrel5mw/land.yaml"
COARSE = ["--set", "blades.elements=2", "--set", "tower.elements=2", "--set", "aero=none"]


def block(duration, checkpoint=0.5, channels="RotSpeed, RootMxb1"):
    return ["--set", f"transient={{duration: {duration}, step: 0.01, start: undeformed, checkpoint: "
                     f"{checkpoint}, output: {{channels: [{channels}]}}}}"]


def series(path):
    with h5py.File(path) as file:
        group = file["transient"]
        return group["time"][:], group["values"][:], group.attrs["status"]


class FaultTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("case.yaml", MINIMAL)

    def start(self, *arguments):
        run = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (run.kill(), run.wait(), run.stderr.close()))
        return run

    def wait_for(self, name, run=None):
        end = time.monotonic() + LONGEST_RUN
        while not (self.folder / name).exists():
            self.assertLess(time.monotonic(), end, name)
            if run is not None:
                self.assertIsNone(run.poll(), "the run has ended")
            time.sleep(0.02)

    def names(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))


class Locks(FaultTest):
    def test_one_run_at_a_time_writes_a_result(self):
        first = self.start("transient", "case.yaml", "-o", "r.h5", *block(1e5))
        self.wait_for("r.h5")
        before = (self.folder / "r.h5").stat().st_size
        for command in ("transient", "modes", "trim"):
            parked = ["--parked"] if command == "modes" else []
            run = self.samara(command, "case.yaml", "-o", "r.h5", *parked, *block(1))
            self.assertEqual(run.returncode, 2, run.stderr)
            for word in ("r.h5: is being written by process", str(first.pid), "-o"):
                self.assertIn(word, run.stderr)
            self.assertNotIn("result:", run.stdout)
        self.succeed("trim", "case.yaml", "-o", "other.h5")
        self.assertGreaterEqual((self.folder / "r.h5").stat().st_size, before)
        # A lock dies with its process, whatever is left of its file.
        first.kill()
        first.communicate()
        self.assertIn(".r.h5.lock", self.names())
        half_written = [name for name in self.names() if name.endswith(".tmp")]
        self.assertLessEqual(len(half_written), 1)
        self.assertEqual(series(self.folder / "r.h5")[2], "running")
        self.succeed("transient", "case.yaml", "-o", "r.h5", *block(1))
        self.assertEqual(self.names(), sorted([*half_written, "case.yaml", "other.h5", "r.h5",
                                               "r.h5.parts", *self.parts("r.h5")]))
        self.assertEqual(series(self.folder / "r.h5")[2], "complete")

    def parts(self, name):
        return [f"{name}.parts/{path.name}"
                for path in sorted((self.folder / f"{name}.parts").iterdir())
                if path.suffix != ".tmp"]  # half-written where the process was killed

    def test_a_symbolic_link_stays_and_its_target_is_locked(self):
        (self.folder / "deep").mkdir()
        self.succeed("trim", "case.yaml", "-o", "deep/r.h5")
        (self.folder / "link.h5").symlink_to("deep/r.h5")
        first = self.start("transient", "case.yaml", "-o", "deep/r.h5", *block(1e5))
        self.wait_for("deep/r.h5.parts")
        run = self.samara("trim", "case.yaml", "-o", "link.h5")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("is being written by", run.stderr)
        first.kill()
        first.communicate()
        self.succeed("transient", "case.yaml", "-o", "link.h5", *block(1))
        self.assertTrue((self.folder / "link.h5").is_symlink())
        self.assertEqual(len(series(self.folder / "deep/r.h5")[0]), 101)
        self.succeed("transient", "case.yaml", "-o", "link.h5", "--restart", "deep/r.h5", *block(2))
        self.assertEqual(len(series(self.folder / "deep/r.h5")[0]), 201)
        self.succeed("export", "link.h5", "-o", "x.csv")


class Folders(FaultTest):
    def test_results_of_one_stem_have_folders_of_their_own(self):
        self.succeed("transient", "case.yaml", "-o", "wind12.5", *block(2))
        before = series(self.folder / "wind12.5")
        self.assertGreater(len(list((self.folder / "wind12.5.parts").iterdir())), 1)
        self.succeed("transient", "case.yaml", "-o", "wind12.7", *block(1))
        for a, b in zip(series(self.folder / "wind12.5"), before):
            numpy.testing.assert_array_equal(a, b)

    def test_foreign_files_in_the_folder_stay(self):
        foreign = {"measured.h5": b"mine", "0123abcd-000001.h5": b"of another result", "a.txt": b""}
        for name, content in foreign.items():
            self.write(f"r.h5.parts/{name}", content)
        for duration in (2, 0.1):
            self.succeed("transient", "case.yaml", "-o", "r.h5", *block(duration, 0.5))
        for name, content in foreign.items():
            self.assertEqual((self.folder / "r.h5.parts" / name).read_bytes(), content)
        # Nothing is left of the replaced run.
        self.succeed("transient", "case.yaml", "-o", "r.h5", *block(0.1, "none"))
        self.assertEqual(sorted(path.name for path in (self.folder / "r.h5.parts").iterdir()),
                         sorted(foreign))

    def test_names_may_be_as_long_as_names_can_be(self):
        name = "a" * 252 + ".h5"
        self.succeed("trim", "case.yaml", "-o", name)
        self.assertEqual(self.names(), sorted([name, "case.yaml"]))
        self.refuse("trim", "case.yaml", "-o", "a" + name, words=["256 bytes", "allows only 255"])
        self.refuse("transient", "case.yaml", "-o", name, *block(1), words=["shorter name"])
        self.succeed("transient", "case.yaml", "-o", name[6:], *block(1))

    def test_a_folder_that_goes_is_an_error_of_the_environment(self):
        (self.folder / "out").mkdir()
        run = self.start("transient", "case.yaml", "-o", "out/r.h5", *block(1e5))
        self.wait_for("out/r.h5")
        while (self.folder / "out").exists():  # it writes there meanwhile
            shutil.rmtree(self.folder / "out", ignore_errors=True)
        error = run.communicate(timeout=LONGEST_RUN)[1]
        self.assertEqual(run.returncode, 1, error)
        self.assertIn("out/r.h5", error)
        self.assertNotIn("unexpected", error)


class Kills(FaultTest):
    def test_whatever_is_killed_goes_on_bit_by_bit(self):
        # Within blocks all over the run, before its first checkpoint and after its end included.
        keys = ["transient", COARSE_TURBINE, *COARSE, *block(5, 0.1, "RotSpeed, TwrBsMyt")]
        self.succeed(*keys, "-o", "whole.h5")
        whole = series(self.folder / "whole.h5")
        blocks = len(list((self.folder / "whole.h5.parts").iterdir()))
        moments = random.Random(4)
        unfinished = 0
        kills = 18
        for i in range(kills):
            name = f"killed{i}.h5"
            run = self.start(*keys, "-o", name)
            parts = self.folder / f"{name}.parts"
            wanted = i * (blocks + 1) // kills
            while run.poll() is None and (
                    wanted > 0 and (not parts.exists() or len(list(parts.iterdir())) < wanted)):
                time.sleep(0.002)
            time.sleep(0.1 * moments.random())
            run.kill()
            run.wait()
            if not (self.folder / name).exists():
                continue
            times, values, status = series(self.folder / name)
            unfinished += status == "running"
            count = len(times)
            with self.subTest(kill=i, rows=count, status=status):
                self.assertGreater(count, 0)
                numpy.testing.assert_array_equal(times, whole[0][:count])
                numpy.testing.assert_array_equal(values, whole[1][:count])
                if count == len(whole[0]):
                    continue
                self.succeed(*keys, "-o", name, "--restart", name)
                for a, b in zip(series(self.folder / name), whole):
                    numpy.testing.assert_array_equal(a, b)
        self.assertGreater(unfinished, kills // 2)

    def test_a_rank_that_is_killed_ends_the_run(self):
        run = subprocess.Popen(
            [MPIEXEC, "-n", "3", PROGRAM, "transient", "case.yaml", "-o", "r.h5", *block(1e5)],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (run.kill(), run.wait(), run.stderr.close()))
        self.wait_for("r.h5", run)
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        ranks = [pid for pid in children
                 if pathlib.Path(f"/proc/{pid}/exe").resolve() == pathlib.Path(f"{PROGRAM}-program").resolve()]
        self.assertEqual(len(ranks), 3)
        os.kill(int(ranks[2]), signal.SIGKILL)
        error = run.communicate(timeout=LONGEST_RUN)[1]
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("signal 9", error)
        times, values, status = series(self.folder / "r.h5")
        self.assertNotEqual(status, "complete")
        self.assertTrue(numpy.isfinite(values).all())
        end = int(times[-1]) + 1
        self.succeed("transient", "case.yaml", "-o", "r.h5", "--restart", "r.h5", *block(end))
        self.assertEqual(len(series(self.folder / "r.h5")[0]), 100 * end + 1)


class Surroundings(FaultTest):
    def run_shell(self, script, **variables):
        return subprocess.run(["bash", "-c", script, "-", PROGRAM], cwd=self.folder, text=True,
                              capture_output=True, timeout=LONGEST_RUN, check=False,
                              env={**os.environ, **variables})

    def test_closed_and_full_outputs_cost_no_result(self):
        # A closed stream's number must not become that of the result.
        self.succeed("transient", "case.yaml", "-o", "good.h5", *block(1))
        good = series(self.folder / "good.h5")
        for i, streams in enumerate((">&-", ">&- 2>&-", "<&- >&- 2>&-", ">/dev/full")):
            with self.subTest(streams=streams):
                words = " ".join(f"'{word}'" for word in block(1))
                run = self.run_shell(f'"$1" transient case.yaml -o {i}.h5 {words} {streams}')
                self.assertEqual(run.returncode, 1)
                if "2>" not in streams:
                    self.assertIn("standard output cannot be written", run.stderr)
                for a, b in zip(series(self.folder / f"{i}.h5"), good):
                    numpy.testing.assert_array_equal(a, b)

    def test_a_locale_with_commas_changes_no_number(self):
        (self.folder / "locales").mkdir()
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8",
                        str(self.folder / "locales/de_DE.UTF-8")], check=False, capture_output=True)
        comma = {"LOCPATH": str(self.folder / "locales"), "LC_ALL": "de_DE.UTF-8"}
        self.assertEqual(self.run_shell("printf '%.1f' 0,5", **comma).stdout, "0,5")
        self.write("loads.yaml", MINIMAL + "loads: [{beam: blades, at: 1, force: [0, 0, 0.5]}]\n")
        outputs = []
        for name, variables in (("c", {}), ("de", comma)):
            script = (f'"$1" trim loads.yaml -o {name}.h5 --csv {name}.csv --set gravity=9.81 && '
                      f'"$1" check loads.yaml && "$1" transient loads.yaml -o {name}2.h5 --set '
                      '"transient={duration: 0.5, step: 0.01, pitch_deg: {formula: 2.5*sin(t)^2}}" && '
                      f'"$1" export {name}2.h5 -o {name}.out && "$1" loads {name}2.h5 -o {name}3.h5')
            run = self.run_shell(script, **variables)
            self.assertEqual(run.returncode, 0, run.stderr)
            table = (self.folder / f"{name}.csv").read_bytes()
            rows = (self.folder / f"{name}.out").read_text().splitlines()[8:]
            words = re.sub(rf"\b{name}(\d?\.(h5|csv|out))", r"x\1", run.stdout)
            words = re.sub(r".* times real time", "", words)
            outputs.append((words, table, rows))
        self.assertEqual(outputs[0], outputs[1])

    @unittest.skipIf(os.geteuid() != 0, "only root can become another user")
    def test_no_permission_is_said_as_such(self):
        self.folder.chmod(0o755)
        self.succeed("trim", "case.yaml", "-o", "r.h5")
        (self.folder / "mine").mkdir(mode=0o700)
        for name in ("case.yaml", "r.h5"):
            shutil.copy(self.folder / name, self.folder / "mine" / name)
        for name in ("secret.yaml", "secret.h5"):
            shutil.copy(self.folder / name.replace("secret.yaml", "case.yaml").replace(
                "secret.h5", "r.h5"), self.folder / name)
            (self.folder / name).chmod(0o600)
        as_nobody = ("setpriv --reuid=65534 --regid=65534 --clear-groups ")
        (self.folder / "out").mkdir()
        (self.folder / "out").chmod(0o777)
        for command in ("trim secret.yaml -o out/x.h5", "export secret.h5 -o out/x.csv",
                        "loads secret.h5 -o out/x.h5", "trim case.yaml -o mine/new.h5",
                        "trim case.yaml -o new.h5", "trim case.yaml -o r.h5",
                        "trim case.yaml -o mine/r.h5", "trim mine/case.yaml -o out/x.h5"):
            with self.subTest(command=command):
                run = self.run_shell(f'{as_nobody} "$1" {command}', HOME="/")
                self.assertEqual(run.returncode, 2, run.stderr)
                self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
                self.assertIn("permission", run.stderr.lower())


class Damage(FaultTest):
    """Last segments as a machine that loses power may leave them."""

    def test_a_damaged_end_costs_no_more_than_its_rows(self):
        self.succeed("transient", "case.yaml", "-o", "whole.h5", *block(4))
        whole = series(self.folder / "whole.h5")
        for lost in (1, 2):
            for damage in ("truncated", "gone"):
                with self.subTest(lost=lost, damage=damage):
                    self.damage(lost, damage, whole)

    def damage(self, lost, damage, whole):
        shutil.rmtree(self.folder / "r.h5.parts", ignore_errors=True)
        self.succeed("transient", "case.yaml", "-o", "r.h5", *block(2))
        for segment in sorted((self.folder / "r.h5.parts").iterdir())[-lost:]:
            if damage == "gone":
                segment.unlink()
            else:
                segment.write_bytes(segment.read_bytes()[:500])
        left = 201 - 50 * lost  # checkpoints every 50 rows end segments
        run = self.succeed("export", "r.h5", "-o", "x.csv")
        self.assertIn("is missing or damaged", run.stderr)
        self.assertIn(f"{left} of 201 rows are left", run.stderr)
        self.assertIn(f"{left} rows of 2 channels", run.stdout)
        self.assertIn("is missing or damaged", self.succeed("loads", "r.h5").stderr)
        self.succeed("export", "r.h5", "-o", "joined.h5")
        for name in ("r.h5", "joined.h5"):
            again = ["transient", "case.yaml", "-o", name, "--restart", name, *block(4)]
            if lost > 1:  # the checkpoints are those of 1.5 and 2 s
                self.refuse(*again, words=["no checkpoint"])
                continue
            self.succeed(*again)
            for a, b in zip(series(self.folder / name), whole):
                numpy.testing.assert_array_equal(a, b)

    def test_a_gap_is_refused(self):
        self.succeed("transient", "case.yaml", "-o", "r.h5", *block(2))
        sorted((self.folder / "r.h5.parts").iterdir())[1].unlink()
        self.refuse("export", "r.h5", "-o", "x.csv", words=["missing or damaged"])
        shutil.rmtree(self.folder / "r.h5.parts")
        self.refuse("loads", "r.h5", words=["missing or damaged", "belongs to the file"])


class Touched(FaultTest):
    """Results that another program has changed: refused with the place, or read right."""

    KINDS = {
        "a text of fixed length": numpy.bytes_(b"complete " * 40),
        "texts": numpy.array([b"abc", b"de"], dtype="S40"),
        "texts in two dimensions": numpy.full((48, 40), b"RootFxb1x", dtype="S9"),
        "texts of any length": numpy.array(["a" * 100] * 500, dtype=h5py.string_dtype()),
        "an integer": numpy.int8(3),
        "a number": numpy.float32(0.5),
        "not a number": numpy.array([numpy.nan]),
        "a negative number": numpy.array([-7.0]),
        "a large number": numpy.array([1e300]),
        "a list": numpy.arange(1000.0),
        "a table": numpy.ones((3, 5)),
        "many dimensions": numpy.ones((2, 2, 2, 2)),
        "nothing": numpy.zeros((0,)),
        "empty": h5py.Empty("f8"),
        "complex numbers": numpy.ones(3, dtype=complex),
    }

    def setUp(self):
        super().setUp()
        self.succeed("transient", "case.yaml", "-o", "good.h5", *block(0.5, "none"))
        self.succeed("transient", "case.yaml", "-o", "parts.h5", *block(1, 0.5))
        self.succeed("trim", "case.yaml", "-o", "trim.h5")

    def replace(self, source, change):
        shutil.copyfile(self.folder / source, self.folder / "bad.h5")
        with h5py.File(self.folder / "bad.h5", "r+") as file:
            change(file)

    def commands(self, name):
        start = block(0.1)[1].replace("start: undeformed", f"start: {name}")
        return (["loads", name], ["export", name, "-o", "x.csv"], ["export", name, "-o", "x.h5"],
                ["transient", "case.yaml", "-o", "y.h5", "--set", start],
                ["transient", "case.yaml", "-o", "y.h5", "--restart", name, *block(2)])

    def test_what_was_seen_to_crash(self):
        def attribute(item, name, value):
            def change(file):
                file[item].attrs[name] = value
            return change

        def dataset(name, value):
            def change(file):
                value_of = value(file[name]) if callable(value) else value
                del file[name]
                file[name] = value_of
            return change

        kinds = self.KINDS
        for change, place in (
                (attribute("transient/checkpoint", "time", kinds["a list"]),
                 "/transient/checkpoint:time"),
                (dataset("transient/model", kinds["texts of any length"]), "/transient/model"),
                (dataset("transient/channel_name", kinds["texts in two dimensions"]),
                 "/transient/channel_name"),
                (dataset("transient/values", lambda values: values[:, :1]), "/transient/values"),
                (dataset("transient/channel_unit", kinds["texts"][:1]), "channel_"),
                (dataset("transient/time", kinds["texts"]), "/transient/values")):
            with self.subTest(place=place):
                self.replace("good.h5", change)
                self.refuse("loads", "bad.h5", words=["bad.h5", place])
        # As MATLAB and numpy write texts.
        self.replace("good.h5", lambda file: [attribute(item, name, numpy.bytes_(value))(file)
                                              for item, name, value in (
                                                  ("transient", "status", b"complete"),
                                                  ("/", "case_path", b"x" * 400))])
        self.assertEqual(self.succeed("loads", "bad.h5").stderr, "")
        self.replace("good.h5", dataset("transient/checkpoint/event_time", numpy.ones(2)))
        self.refuse("transient", "case.yaml", "-o", "y.h5", "--set",
                    "transient={duration: 0.1, step: 0.01, start: bad.h5}", words=["event_time"])

    def test_texts_without_end_take_no_memory(self):
        for kind in ("S1", h5py.string_dtype()):
            def change(file, kind=kind):
                del file["transient/channel_name"]
                file.create_dataset("transient/channel_name", shape=(1 << 28,), dtype=kind)

            with self.subTest(kind=kind):
                self.replace("good.h5", change)
                self.refuse("loads", "bad.h5",
                            words=["/transient/channel_name", "has too many texts"])

    def test_any_item_of_any_kind_is_read_or_refused(self):
        random_numbers = random.Random(os.environ.get("SAMARA_SEED", "7"))
        for source in ("good.h5", "parts.h5", "trim.h5"):
            with h5py.File(self.folder / source) as file:
                items = [("/", name) for name in file.attrs]
                file.visititems(lambda name, item: items.extend(
                    [(name, None)] * isinstance(item, h5py.Dataset)
                    + [(name, one) for one in item.attrs if one not in ("unit", "frame",
                                                                       "description")]))
            for _ in range(int(os.environ.get("SAMARA_TRIALS", "40"))):
                item, attribute = random_numbers.choice(items)
                kind = random_numbers.choice(list(self.KINDS))

                def change(file, item=item, attribute=attribute, kind=kind):
                    if attribute is None:
                        del file[item]
                        file[item] = self.KINDS[kind]
                    else:
                        file[item].attrs[attribute] = self.KINDS[kind]

                self.replace(source, change)
                command = random_numbers.choice(self.commands("bad.h5"))
                with self.subTest(source=source, item=item, attribute=attribute, kind=kind,
                                  command=command):
                    run = self.samara(*command)
                    self.assertIn(run.returncode, (0, 2), run.stderr)

    def test_links_and_data_of_others_are_no_damage(self):
        self.succeed("transient", "case.yaml", "-o", "good.h5", *block(1))
        self.succeed("export", "good.h5", "-o", "good.h5.csv")

        def move(file):
            file.move("transient", "/store")
            file["transient"] = h5py.SoftLink("/store")

        def alias(file):
            file["alias"] = file["transient"]

        def filtered(file):  # by a filter that the program's HDF5 does not have
            file.create_dataset("notes/mine", data=numpy.zeros((100, 100)), compression="lzf")

        def heavy(file):
            for i in range(20):
                file.create_dataset(f"notes/{i}", data=numpy.zeros((2000, 1000)),
                                    compression="gzip")

        def long(file):
            file["notes/text"] = "x" * 70_000_000

        def repacked(file):
            values = file["transient/values"][:]
            del file["transient/values"]
            file.create_dataset("transient/values", data=values, chunks=(10, 1), shuffle=True,
                                compression="gzip")

        for change in (move, alias, filtered, heavy, long, repacked):
            with self.subTest(change=change.__name__):
                shutil.copy(self.folder / "good.h5", self.folder / "r.h5")
                with h5py.File(self.folder / "r.h5", "r+") as file:
                    change(file)
                self.succeed("export", "r.h5", "-o", "r.csv")
                self.assertEqual((self.folder / "r.csv").read_bytes(),
                                 (self.folder / "good.h5.csv").read_bytes())

    def test_a_result_that_is_replaced_meanwhile_is_one_or_the_other(self):
        self.succeed("transient", "case.yaml", "-o", "a.h5", *block(1, "none"))
        shutil.copy(self.folder / "a.h5", self.folder / "b.h5")
        with h5py.File(self.folder / "b.h5", "r+") as file:
            names = file["transient/channel_name"]
            names[...] = [b"B_" + name for name in names[:]]
            file["transient/values"][...] = 7.0
        (self.folder / "r.h5").symlink_to("a.h5")
        done = threading.Event()

        def swap():
            while not done.is_set():
                for name in ("b.h5", "a.h5"):
                    (self.folder / "new").symlink_to(name)
                    (self.folder / "new").rename(self.folder / "r.h5")

        swapper = threading.Thread(target=swap)
        swapper.start()
        try:
            for _ in range(30):
                self.succeed("export", "r.h5", "-o", "r.csv")
                lines = (self.folder / "r.csv").read_text().splitlines()
                values = {line.split(",")[1] for line in lines[1:]}
                self.assertEqual("B_" in lines[0], values == {"7"}, lines[0])
        finally:
            done.set()
            swapper.join()

    def test_what_a_newer_version_wrote_is_refused(self):
        self.replace("good.h5", lambda file: file.attrs.modify("samara_schema", numpy.int32(99)))
        for command in self.commands("bad.h5"):
            with self.subTest(command=command):
                self.refuse(*command, words=["bad.h5", "newer samara", "schema 99"])

    def test_files_that_are_no_results(self):
        os.mkfifo(self.folder / "pipe.h5")
        self.write("text.h5", "text")
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["a"] = 1
        for name, word in (("pipe.h5", "not a plain file"), ("text.h5", "is no result of samara"),
                           ("foreign.h5", "of another program"), ("none.h5", "no such file"),
                           (".", "a directory")):
            for command in self.commands(name):
                if name == "." and any("start: ." in one for one in command):
                    continue  # no name of a result
                with self.subTest(name=name, command=command):
                    run = self.samara(*command)
                    self.assertEqual(run.returncode, 2, run.stderr)
                    self.assertIn(word, run.stderr)
        os.mkfifo(self.folder / "pipe.yaml")
        self.refuse("check", "pipe.yaml", words=["not a plain file"])

    def test_a_lifetime_is_that_of_one_turbine(self):
        self.write("other.yaml", MINIMAL.replace("EI2: 1e4", "EI2: 2e4"))
        self.succeed("transient", "other.yaml", "-o", "b.h5", *block(0.5))
        self.succeed("transient", "case.yaml", "-o", "c.h5", "--set", "shaft.speed=5", *block(0.5))
        hours = ["--set", "hours=[1, 1]", "--set", "channels=[RootMxb1]"]
        self.refuse("loads", "good.h5", "b.h5", *hours, words=["b.h5: is of another model", "EI2"])
        self.succeed("loads", "good.h5", "c.h5", *hours)


class Signals(FaultTest):
    def send(self, arguments, number, delay):
        """Sends a signal so long after the launcher holds signals back; its exit code and what it said."""
        run = self.start(*arguments)
        wait_until_it_stands(run)
        time.sleep(delay)
        run.send_signal(number)
        error = run.communicate(timeout=LONGEST_RUN)[1]
        return run.returncode, error

    def test_a_signal_ends_with_its_code_at_any_moment(self):
        arguments = ["transient", "case.yaml", "-o", "r.h5", *block(1, 0.25)]
        began = time.monotonic()
        self.succeed(*arguments)
        lasts = time.monotonic() - began
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)):
            for i in range(20):
                shutil.rmtree(self.folder / "r.h5.parts", ignore_errors=True)
                (self.folder / "r.h5").unlink(missing_ok=True)
                found, error = self.send(arguments, number, 1.2 * lasts * (i / 20) ** 2)
                with self.subTest(signal=number, moment=i):
                    self.assertIn(found, (code, 0), error)  # 0: it had ended
                    if found == code:
                        self.assertIn("interrupted", error)
                    elif i == 0:
                        self.fail("ended before the first signal")
                    if (self.folder / "r.h5").exists():
                        times, values, _ = series(self.folder / "r.h5")
                        self.assertEqual(len(times), len(values))
                        self.assertTrue(numpy.isfinite(values).all())
                    self.assertFalse([name for name in self.names()
                                      if name.endswith((".tmp", ".lock", ".room"))])

    def test_a_signal_while_libraries_are_loaded_waits_for_them(self):
        for words, own in ((["trim", "case.yaml", "-o", "x.h5"], 0), (["--version"], 0), (["plot", "x.h5"], 2)):
            ended = 0
            for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
                for milliseconds in (0, 5, 20, 50):
                    with self.subTest(words=words, number=number, milliseconds=milliseconds):
                        found, error = self.send(words, number, 1e-3 * milliseconds)
                        ended += found == own
                        if found == own:
                            (self.folder / "x.h5").unlink(missing_ok=True)
                        else:
                            self.assertEqual((found, error), (code, "samara: interrupted\n"))
                        self.assertEqual(self.names(), ["case.yaml"])
            self.assertLess(ended, 8, words)

    def test_a_launcher_without_its_program_says_so(self):
        alone = self.folder / "samara"
        shutil.copy2(PROGRAM, alone)
        run = subprocess.run([alone, "--version"], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr, f"samara: {alone}-program: No such file or directory; "
                                     "hint: the program is installed beside samara\n")

    def test_other_commands_end_at_once_and_write_nothing(self):
        for command in ("trim", "floquet"):
            found, error = self.send([command, "case.yaml", "-o", "x.h5"], signal.SIGINT, 0)
            self.assertEqual(found, 130, error)
            self.assertEqual(self.names(), ["case.yaml"])

    def test_the_second_signal_does_not_wait(self):
        run = self.start("transient", "case.yaml", "-o", "r.h5", *block(1e5))
        self.wait_for("r.h5")
        for _ in range(2):
            run.send_signal(signal.SIGINT)
        run.communicate(timeout=LONGEST_RUN)
        self.assertEqual(run.returncode, 130)

    def test_what_the_parent_ignores_is_ignored(self):
        command = f'trap "" INT; exec {PROGRAM} transient case.yaml -o r.h5 "$@"'
        run = subprocess.Popen(["bash", "-c", command, "-", *block(1, 0.5)], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(0.05)
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=LONGEST_RUN)
        self.assertEqual(run.returncode, 0)


class Size(FaultTest):
    """Inputs that are large or nested are read in their proper time and memory, or refused."""

    def check(self, name, code, word):
        limited = 'ulimit -v 4000000; exec "$@"'
        run = subprocess.run(["bash", "-c", limited, "-", PROGRAM, *name], cwd=self.folder,
                             capture_output=True, text=True, timeout=LONGEST_RUN, check=False)
        self.assertEqual(run.returncode, code, run.stderr[-500:])
        self.assertIn(word, run.stdout + run.stderr)

    def test_keys_sections_anchors_and_decks(self):
        many = "".join(f"k{i}: 1\n" for i in range(300000))
        self.write("keys.yaml", MINIMAL + many)
        self.check(["check", "keys.yaml"], 2, "and 299900 more errors")
        self.write("twice.yaml", MINIMAL + "title: a\n" * 300000)
        self.check(["check", "twice.yaml"], 2, "more errors")
        head, row = MINIMAL.split("  sections:\n")
        row = row.replace("    - mass", "    - at: {}\n      mass")
        count = 20000
        self.write("sections.yaml", head + "  sections:\n" + "".join(
            row.replace("{}", repr(i / (count - 1))) for i in range(count)))
        self.check(["check", "sections.yaml"], 0, "degrees of freedom")
        anchors = "".join(f"&a{i} [ " for i in range(60))
        self.write("anchors.yaml", "samara: 1\nx: " + anchors + ",".join(["1"] * 1500000)
                   + "]" * 60 + "\n")
        self.check(["check", "anchors.yaml"], 2, "anchors.yaml:2:")
        self.write("long.yaml", MINIMAL + "? " + "a" * 5000000 + "\n: 1\n")
        self.check(["check", "long.yaml"], 2, "unknown key")
        self.write("deck.fst", "------- OpenFAST\n" + "1 GenDOF - x\n" * 1500000)
        self.check(["import", "openfast", "deck.fst", "-o", "x.yaml"], 2, "deck.fst")

    def test_tables_of_cycles(self):
        self.succeed("transient", "case.yaml", "-o", "r.h5", *block(1, "none"))
        self.check(["loads", "r.h5", "--set", "bins=10000"], 2, "50 million entries")


class Options(FaultTest):
    def test_options_of_the_current_folder_are_not_read(self):
        self.write(".petscrc", "-log_view :notes.txt\n")
        self.write("petscrc", "-log_view :notes.txt\n")
        self.write("notes.txt", "precious")
        self.succeed("trim", "case.yaml", "-o", "x.h5")
        self.assertEqual((self.folder / "notes.txt").read_text(encoding="utf-8"), "precious")

    def test_options_of_the_home_folder_are(self):
        home = self.folder / "home"
        home.mkdir()
        (home / ".petscrc").write_text("-trim_snes_max_it 0\n", encoding="utf-8")
        arguments = [PROGRAM, "trim", "case.yaml", "-o", "x.h5", "--set", "gravity=9.81"]
        for options, code in (([], 3), (["-trim_snes_max_it", "20"], 0),
                              (["-options_file", "home/.petscrc"], 3)):
            run = subprocess.run(arguments + options, cwd=self.folder, check=False,
                                 capture_output=True, env={**os.environ, "HOME": str(home)})
            self.assertEqual(run.returncode, code, run.stderr)


class FullDisk(FaultTest):
    def test_a_full_disk_leaves_a_result_that_says_so(self):
        # A file system of its own, 4 MB; a user name space lets anyone mount it.
        keys = block(2000, 5, "RotSpeed, RootMxb1, RootMyb1, RootMzb1, RootFxb1, RootFyb1")
        script = ('mount -t tmpfs -o size=4m none small && cd small && '
                  '"$@" ; code=$?; cp -a . ../kept; exit $code')
        (self.folder / "small").mkdir()
        command = ["unshare", "-rm", "bash", "-c", script, "-", PROGRAM, "transient",
                   "../case.yaml", "-o", "r.h5", *keys]
        if subprocess.run(["unshare", "-rm", "true"], check=False,
                          capture_output=True).returncode:
            self.skipTest("user name spaces are forbidden here")
        run = subprocess.run(command, cwd=self.folder, capture_output=True, text=True,
                             timeout=LONGEST_RUN, check=False)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("No space left on device", run.stderr)
        times, values, status = series(self.folder / "kept/r.h5")
        self.assertRegex(status, "^failed: .*No space left on device")
        self.assertGreater(len(times), 1000)
        self.assertTrue(numpy.isfinite(values).all())
        names = [path.name for path in (self.folder / "kept").rglob("*")]
        self.assertFalse([name for name in names if name.endswith((".tmp", ".room", ".lock"))], names)
        # With room again it goes on.
        end = int(times[-1]) + 20
        self.succeed("transient", "case.yaml", "-o", "kept/r.h5", "--restart", "kept/r.h5",
                     "--set", keys[1].replace("2000", str(end)))
        times, values, status = series(self.folder / "kept/r.h5")
        self.assertEqual(status, "complete")
        self.assertEqual(len(times), 100 * end + 1)
        self.assertTrue(numpy.isfinite(values).all())


unittest.main()
