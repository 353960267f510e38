"""Do the rows of a sweep depend on nothing but their points?"""

import csv
import io
import json
import os
import signal
import socket
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import watchsim as ws
from watchsim.cli import main
from watchsim.render.study_plot import plot_sweep
from watchsim.scene.keys import in_words
from watchsim.studies.axes import Axis, axes_from_texts, axes_from_values, slug
from watchsim.studies.journal import NAME
from watchsim.studies.point import Question, function_of, outputs_named
from watchsim.studies.study_report import sweep_text
from watchsim.studies.sweep import Sweep, swept
from watchsim.studies.workers import Here

ROOT = Path(ws.__file__).resolve().parents[1]
BENCH = ws.profiles_dir() / "bench_lever"
VALUES = {"torques.0.value": [-5e-6, -6e-6], "contacts.0.friction": [0.1, 0.15]}


@pytest.fixture(scope="module")
def bench():
    return ws.load(BENCH)


@pytest.fixture(scope="module")
def table(bench):
    return ws.sweep(bench, VALUES)


def test_every_point_is_its_own_cycle(bench, table):
    assert table.whole
    assert [row["torques.0.value"] for row in table.rows] == [-5e-6, -5e-6, -6e-6, -6e-6]
    row = table.rows[3]
    alone = ws.steady(bench.set("torques.0.value", -6e-6).set("contacts.0.friction", 0.15))
    assert row["amplitude_deg"] == alone.amplitude_deg
    assert row["rate_s_per_d"] == alone.rate_s_per_d
    assert table["amplitude"][3] == table.column("amplitude_deg")[3] == alone.amplitude_deg
    assert row["verdict"] == "ticks"


def test_two_workers_and_another_order_give_the_same(bench, table):
    """To the last bit: no point begins where another one ended."""
    backwards = {key: list(reversed(values)) for key, values in VALUES.items()}
    assert list(reversed(ws.sweep(bench, backwards, workers=2).rows)) == list(table.rows)


def test_workers_import_the_package_that_started_them(tmp_path):
    """Whatever lies in the current folder, such as a checkout of another state."""
    (tmp_path / "watchsim").mkdir()
    (tmp_path / "watchsim" / "__init__.py").write_text("raise RuntimeError('not this one')")
    command = (
        f"import sys; sys.path.insert(1, {str(ROOT)!r}); sys.path.remove(''); from watchsim.cli import main; main(sys.argv[1:])"
    )
    asked = [sys.executable, "-c", command, "sweep", str(BENCH), "contacts.0.friction=0.1,0.12", "--workers", "2", "--json"]
    done = subprocess.run([*asked, "--duration", "10 ms"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and len(json.loads(done.stdout)["rows"]) == 2, done.stderr


def test_by_runs(bench, table):
    """The end of a run that has settled is the cycle."""
    runs = ws.sweep(bench, {"torques.0.value": [-6e-6]}, steady=False, duration="40 s")
    assert runs.rows[0]["amplitude_deg"] == pytest.approx(table.rows[3]["amplitude_deg"], abs=1e-5)
    assert runs.rows[0]["verdict"] == "ticks"


def test_what_fails_keeps_its_reason(bench):
    """A torque too low, a wheel inside the pallets, and no oscillator."""
    found = ws.sweep(bench, {"bodies.lever.position.1": ["2.886751346 mm", "2.6 mm"]})
    assert [row["verdict"] for row in found.rows] == ["ticks", None]
    assert "overlap" in found.rows[1]["message"]
    assert np.isnan(found["amplitude"]).tolist() == [False, True]
    assert found["verdict"].tolist() == ["ticks", None]
    stopped = ws.sweep(bench.set("run.duration", "8 s"), {"torques.0.value": ["-0.01 µN·m"]})
    assert stopped.rows[0]["verdict"] == "stops"
    incline = ws.sweep(ws.profiles_dir() / "incline", {"contacts.0.friction": [0.2]})
    assert "nothing" in incline.rows[0]["message"]


def test_dimensions_that_cannot_be_drawn_are_points_unless_all_are():
    """A cylinder's balance would let off no tooth at 0.004 and 0.003 µN·m; at 0.5 µN·m, which once was refused, it ticks."""
    scene = ws.designs.cylinder(torque="0.4 µN·m").scene()
    found = ws.sweep(scene, {"design.torque": ["0.004 µN·m", "0.5 µN·m"]})
    assert [row["verdict"] for row in found.rows] == [None, "ticks"] and 160.0 < found.rows[1]["amplitude_deg"] < 180.0
    assert found.rows[0]["message"].startswith("the balance would swing by ")
    with pytest.raises(ws.SceneError, match="let off no tooth"):
        ws.sweep(scene, {"design.torque": ["0.004 µN·m", "0.003 µN·m"]})


class Stopping(Here):
    """An executor that is interrupted after some rows, as by Ctrl-C."""

    def __init__(self, rows):
        self.rows = rows

    def answers(self, question, points, interrupted):
        for number, row in super().answers(question, points, interrupted):
            if self.rows == 0:
                return
            self.rows -= 1
            yield number, row


def test_going_on(bench, table, tmp_path):
    """What was finished is taken up; a line that was cut off is computed again."""
    question, axes, outputs = (
        Question(bench),
        axes_from_values(bench, VALUES),
        outputs_named(("amplitude", "rate", "beat_error")),
    )
    part = swept(question, axes, outputs, Stopping(2), folder=tmp_path)
    assert not part.whole
    assert list(part.rows) == list(table.rows[:2])
    journal = tmp_path / NAME
    journal.write_bytes(journal.read_bytes()[:-20])
    counted = Stopping(9)
    whole = swept(question, axes, outputs, counted, folder=tmp_path, resume=True)
    assert counted.rows == 6
    assert whole.whole
    assert list(whole.rows) == list(table.rows)


def test_going_on_with_something_else_is_refused(bench, tmp_path):
    ws.sweep(bench, {"torques.0.value": [-6e-6]}, folder=tmp_path)
    for scene, values, words in (
        (bench.set("damping.0.q_factor", 60), {"torques.0.value": [-6e-6]}, "scene has changed"),
        (bench, {"torques.0.value": [-6e-6, -7e-6]}, "were 1 values .* now 2"),
        (bench, {"contacts.0.friction": [0.1]}, "keys were torques.0.value, now contacts.0.friction"),
    ):
        with pytest.raises(ValueError, match=words):
            ws.sweep(scene, values, folder=tmp_path, resume=True)
    with pytest.raises(ValueError, match="computed was by shooting, now by runs"):
        ws.sweep(bench, {"torques.0.value": [-6e-6]}, steady=False, folder=tmp_path, resume=True)


def test_outputs_by_name(bench):
    with pytest.raises(ValueError, match='Did you mean "amplitude"'):
        ws.sweep(bench, VALUES, outputs=["amplitud"])


def test_without_dask(bench, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ValueError, match=r"pip install 'watchsim\[cluster\]'"):
        ws.sweep(bench, VALUES, scheduler="tcp://127.0.0.1:8786")


def test_the_command(tmp_path, capsys):
    folder = tmp_path / "study"
    asked = ["sweep", str(BENCH), "torques.0.value=-5:-6:2 µN·m", "--workers", "1", "-o", str(folder)]
    assert main([*asked, "--json", "--outputs", "amplitude"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert set(told) == {"keys", "outputs", "rows", "wall_s"}
    assert told["outputs"] == ["amplitude_deg"]
    assert told["rows"][1]["torques.0.value"] == pytest.approx(-6e-6)
    with (folder / "sweep.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert float(rows[1]["amplitude_deg"]) == told["rows"][1]["amplitude_deg"]
    assert float(rows[1]["torques.0.value_N_m"]) == pytest.approx(-6e-6)
    assert (folder / "sweep.png").stat().st_size > 10_000
    assert (folder / "sweep.svg").is_file()
    assert main(asked) == 2
    assert "--resume" in capsys.readouterr().err
    assert main([*asked, "--resume", "--no-plots"]) == 0
    assert "290.734" in capsys.readouterr().out


def test_bad_commands(tmp_path, capsys):
    folder = str(tmp_path / "none")
    assert main(["sweep", str(BENCH), "-o", folder]) == 2
    assert main(["sweep", str(BENCH), "torques.0.value=1:2:3", "nonsense=3", "-o", folder]) == 2
    told = capsys.readouterr().err
    assert "name a key" in told and "a bare number needs a unit" in told and "nonsense" in told
    assert not Path(folder).exists()


def test_the_steady_command(capsys):
    assert main(["steady", str(BENCH), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    names = "found verdict amplitude_deg period_s rate_s_per_d beat_error_ms multipliers simulated_s wall_s"
    assert set(names.split()) <= set(told)
    assert told["verdict"] == "ticks"
    assert main(["steady", str(BENCH)]) == 0
    assert "290.73" in capsys.readouterr().out
    assert main(["steady", str(BENCH), "--set", "torques.0.value=-0.01 µN·m", "--set", "run.duration=8 s"]) == 1
    assert "stops" in capsys.readouterr().out
    assert main(["steady", str(BENCH), "--tol", "3"]) == 2


def stopped(folder: Path, count: int, number: int) -> tuple[list[str], int]:
    """The command of a sweep over so many points that gets a signal after its first rows, and the status it ends with."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    asked = ["sweep", str(BENCH), f"torques.0.value=-5:-8:{count} µN·m", "--no-plots", "-o", str(folder)]
    started = subprocess.Popen(
        [sys.executable, "-m", "watchsim", *asked, "--workers", "2"],
        env=environment,
        cwd=ROOT,
        start_new_session=True,
        stdout=subprocess.DEVNULL,
    )
    journal = folder / NAME
    while not (journal.is_file() and journal.read_bytes().count(b"\n") >= 5) and started.poll() is None:
        time.sleep(0.02)
    os.kill(started.pid, number)
    return asked, started.wait(60)


@pytest.mark.skipif(os.name == "nt", reason="signals to groups of processes")
@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), pytest.param(signal.SIGKILL, -9, marks=pytest.mark.slow)])
def test_stopped_from_outside(tmp_path, number, status):
    """Finished rows are kept, no worker stays behind, and --resume gives the rows of a sweep that nobody has stopped."""
    for count in (20, 80, 320):  # where this process has to wait for its turn, a short sweep is done before it is stopped
        folder = tmp_path / f"study{count}"
        asked, ended = stopped(folder, count, number)
        if ended != 0:
            break
    assert ended == status
    journal = folder / NAME
    kept = journal.read_bytes().count(b"\n") - 1
    assert 4 <= kept < count
    assert main([*asked, "--workers", "1", "--resume"]) == 0
    rows = [json.loads(line) for line in journal.read_text(encoding="utf-8").splitlines()[1:]]
    assert sorted(row["point"] for row in rows) == list(range(count))
    told = json.loads((folder / "sweep.json").read_text(encoding="utf-8"))["rows"]
    amplitudes = [row["amplitude_deg"] for row in told]
    assert amplitudes == sorted(amplitudes)
    alone = ws.steady(ws.load(BENCH).set("torques.0.value", told[3]["torques.0.value"]))
    assert told[3]["amplitude_deg"] == alone.amplitude_deg


def test_no_earlier_picture_stands_beside_new_rows(bench, tmp_path):
    """Whoever begins anew and is killed leaves its rows alone."""
    for name in ("sweep.png", "sweep.json", "mine.png"):
        (tmp_path / name).write_text("earlier")
    axes = axes_from_values(bench, VALUES)
    swept(Question(bench), axes, outputs_named(("rate",)), Stopping(1), folder=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.png", NAME]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="finds children in /proc")
def test_a_killed_worker_costs_nothing(tmp_path):
    asked = [
        *("sweep", str(BENCH), "torques.0.value=-5:-8:40 µN·m", "--no-plots", "--workers", "2", "-o"),
        str(tmp_path / "study"),
    ]
    command = [sys.executable, "-m", "watchsim", *asked]
    started = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    journal, killed = tmp_path / "study" / NAME, 0
    while started.poll() is None:
        time.sleep(0.02)
        finished = journal.read_bytes().count(b"\n") if journal.is_file() else 0
        if killed < 2 and finished > 4 * (killed + 1) and (workers := children(started.pid)):
            os.kill(workers[-1], signal.SIGKILL)
            killed += 1
    assert killed == 2 and started.returncode == 0 and "Traceback" not in started.communicate()[1]
    points = [json.loads(line)["point"] for line in journal.read_text().splitlines()[1:]]
    assert sorted(points) == list(range(40))


def children(number: int) -> list[int]:
    path = Path(f"/proc/{number}/task/{number}/children")
    return [int(child) for child in path.read_text().split()] if path.is_file() else []


@pytest.mark.slow
@pytest.mark.parametrize("lost, status", [("worker", 0), ("scheduler", 3)])
def test_a_cluster_that_loses_somebody(tmp_path, lost, status):
    """Another worker takes over from one that was killed; without the scheduler the rows are kept, and a sentence says why."""
    pytest.importorskip("distributed")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"

    def dask(what: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.dask_{what}", *options, "--no-dashboard"]
        return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    worker = ("worker", address, "--nthreads", "1", "--no-nanny")
    cluster = {"scheduler": dask("scheduler", "--host", address), "worker": dask(*worker)}
    journal = tmp_path / "study" / NAME
    asked = ["sweep", str(BENCH), "torques.0.value=-5:-8:40 µN·m", "--no-plots", "-o", str(tmp_path / "study")]
    try:
        command = [sys.executable, "-m", "watchsim", *asked, "--scheduler", address]
        started = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while not (journal.is_file() and journal.read_bytes().count(b"\n") > 3) and started.poll() is None:
            time.sleep(0.02)
        cluster[lost].kill()
        cluster["another"] = dask(*worker)
        said = started.communicate(timeout=120)[1]
    finally:
        for one in cluster.values():
            one.kill()
            one.wait()
    rows = len(journal.read_text().splitlines()) - 1
    assert started.returncode == status, said
    assert "Traceback" not in said and (rows == 40 if status == 0 else 3 <= rows < 40 and "was lost" in said), said


SCENE = ws.load(ws.profiles_dir() / "bench_lever")


def values(text):
    return axes_from_texts(SCENE, [text])[0].values


@pytest.mark.parametrize(
    "told", ["-4:-8:3 µN·m", "-4 µN·m:-8 µN·m:3", "-4e-3 mN·m : -8 µN·m : 3", "-4,-6,-8 µN·m", "-4 µN·m,-6 µN·m, -0.008 mN·m"]
)
def test_units_at_either_end(told):
    assert values(f"torques.0.value={told}") == pytest.approx([-4e-6, -6e-6, -8e-6], rel=1e-12)


def test_plain_numbers_and_texts():
    assert values("contacts.0.friction=0.1:0.2:3") == pytest.approx([0.1, 0.15, 0.2])
    assert values("contacts.0.friction=10:20:3 %") == pytest.approx([0.1, 0.15, 0.2])
    assert values("bodies.wheel.drawing=wheel.dxf") == ("wheel.dxf",)
    assert values("torques.0.value=-6 µN·m") == pytest.approx([-6e-6])


def test_columns_carry_units():
    axis = axes_from_texts(SCENE, ["springs.0.stiffness=0.7:0.8:2 µN·m/rad"])[0]
    assert axis.column == "springs.0.stiffness_N_m_per_rad"
    assert slug("m/s²") == "m_per_s2"


@given(st.lists(st.floats(0.01, 0.5), min_size=1, max_size=5))
def test_numbers_from_python_stay_to_the_last_bit(numbers):
    assert axes_from_values(SCENE, {"contacts.0.friction": numbers})[0].values == tuple(numbers)


@pytest.mark.parametrize(
    "text, words",
    [
        ("torques.0.value=1:2:3", "a bare number needs a unit"),
        ("torques.0.value=1:2 µN·m", "FROM:TO:N"),
        ("torques.0.value=1:2:0 µN·m", "whole number"),
        ("torques.0.value=1:2:1 µN·m", "one value"),
        ("torques.0.value=1:2:1000000000 µN·m", "more than"),
        ("torques.0.value=1:2:3 mm", "length"),
        ("torques.0.value", "KEY=FROM:TO:N"),
        ("torques.0.valeu=1,2 µN·m", "value"),
        ("torques.7.value=1,2 µN·m", "no entry 7"),
        ("contacts.0.friction=-1,0.2", "friction"),
    ],
)
def test_what_cannot_be_read(text, words):
    with pytest.raises(ws.SceneError, match=words):
        axes_from_texts(SCENE, [text])


def test_all_faults_at_once():
    with pytest.raises(ws.SceneError) as error:
        axes_from_texts(
            SCENE,
            ["torques.0.value=1:2:3", "nonsense", "contacts.9.friction=0.1,0.2", "run.duration=1,2 s", "run.duration=3 s"],
        )
    assert len(error.value.faults) == 4


TORQUE = Axis("torques.0.value", (-1e-6, -2e-6, -3e-6), "N·m", "µN·m")
FRICTION = Axis("contacts.0.friction", tuple(0.01 * i for i in range(9)))
DRAWING = Axis("bodies.wheel.drawing", ("a.dxf", "b.dxf"))


def made(*axes):
    import itertools

    rows = []
    for values in itertools.product(*(axis.values for axis in axes)):
        row = dict(zip((axis.key for axis in axes), values, strict=True))
        good = len(rows) % 4 != 3
        row |= {"amplitude_deg": 280.0 - len(rows) if good else None, "amplitude_deg_error": 0.1 if good else None}
        rows.append({**row, "verdict": "ticks" if good else "knocks", "message": ""})
    return Sweep("A watch", axes, outputs_named(["amplitude"]), tuple(rows), True, 0.0)


def words(figure):
    figure.savefig(io.BytesIO(), format="png")
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    labels = [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]
    return texts + labels + [axes.get_title(loc="right") for axes in figure.axes]


def test_the_title_leaves_out_what_is_swept():
    """A lever of 15 teeth is not what a sweep over teeth shows."""
    scene = ws.designs.swiss_lever().scene()
    assert scene.title == "Swiss lever, 28800 vph, 15 teeth"
    titles = [ws.sweep(scene, values).title for values in ({"design.teeth": [14, 15]}, {"contacts.0.friction": [0.12]})]
    assert titles == ["Swiss lever, 28800 vph", scene.title]


def test_labels_count_as_keys_do():
    said = {"torques.0.value": "torque 0", "scene.gravity.1": "gravity y", "bodies.wheel.position.0": "wheel position x"}
    assert {key: in_words(key) for key in said} == said
    assert in_words("bodies.lever.adjust.STONES.turn") == "lever STONES turn" and in_words("design.teeth") == "teeth"


def test_a_curve_in_usual_units_with_what_failed():
    found = words(plot_sweep(made(FRICTION)))
    assert "contact 0 friction" in found and "amplitude (°)" in found and "knocks" in found


def test_a_family_and_a_map():
    figure = plot_sweep(made(TORQUE, DRAWING))
    assert "torque 0 magnitude (µN·m)" in words(figure)  # it turns clockwise; the curves run from weak to strong
    assert [sorted(line.get_xdata())[0] for line in figure.axes[0].get_lines()][:1] == [pytest.approx(1.0)]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a.dxf", "b.dxf"]
    other = Axis("springs.0.stiffness", tuple(1e-6 * (1.0 + 0.1 * i) for i in range(8)), "N·m/rad", "µN·m/rad")
    assert "grey: knocks" in words(plot_sweep(made(FRICTION, other)))


def test_what_cannot_be_drawn():
    with pytest.raises(ValueError, match="one or two keys"):
        plot_sweep(made(DRAWING))
    with pytest.raises(ValueError, match="one or two keys"):
        plot_sweep(made(TORQUE, FRICTION, DRAWING))


def test_from_the_package():
    assert ws.plot_sweep is plot_sweep


def test_the_least_draw_is_not_called_as_that_on_the_bank():
    """13° by the design, two degrees of travel less at the corner."""
    drawn = ws.designs.swiss_lever()
    (output,) = outputs_named(["draw"])
    assert drawn.dimensions["draw"] == "13°"
    assert function_of(drawn.scene(), 1)[output.column] == pytest.approx(11.0, abs=0.01)
    assert output.label == "least draw from bank to corner"


def test_a_reason_names_its_points(table):
    """The first of them in full, and how many share it."""
    rows = [row | {"message": "" if number % 2 else "no cycle"} for number, row in enumerate(table.rows)]
    said = sweep_text(replace(table, rows=tuple(rows))).splitlines()[-1]
    first = [word for axis in table.axes for word in (axis.key, axis.usual)]
    assert all(word in said for word in first)
    assert said.endswith(f" and {len(rows[::2]) - 1} more: no cycle")
