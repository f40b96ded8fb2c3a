"""The Python API: names, shapes, errors; numbers against closed forms."""

import threading
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sunpeak as sp
from sunpeak.files import whole_file
from sunpeak.rooms import FABRIC, write_fabric

LUMINANCE = 179 * np.array([0.265, 0.670, 0.065])

SPHERE = "void plastic white 0 0 5 .5 .5 .5 0 0\nwhite bubble furnace 0 0 4 0 0 0 5\n"
LAMP = "void light lamp 0 0 3 10 20 30\nlamp sphere bulb 0 0 4 0 0 3 .1\n"
UPWARDS = "-vth -vp 0 0 0 -vd 0 0 1 -vu 0 1 0 -vh 180 -vv 180"
FISHEYE = "-vth -vp 0 0 0 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180"


@pytest.fixture(scope="module")
def cloth(tmp_path_factory: pytest.TempPathFactory) -> sp.Bsdf:
    return sp.Bsdf.load(write_fabric(tmp_path_factory.mktemp("fabric"), "t3-1024"))


class TestBsdf:
    def test_shapes_follow_the_input(self, cloth: sp.Bsdf) -> None:
        w_in = sp.direction([0.0, 20.0, 130.0], [0.0, 50.0, 90.0])
        assert w_in.shape == (3, 3)
        assert cloth.evaluate(w_in, -w_in).shape == (3,)
        assert cloth.evaluate(w_in, [0, 0, -1], colour=True).shape == (3, 3)
        assert cloth.through([0, 0, 1]).shape == (1,)
        assert cloth.through(w_in, colour=True).shape == (3, 3)
        assert cloth.hemispherical(w_in, "reflection").shape == (3,)
        assert cloth.pdf(w_in, w_in).shape == (3,)
        assert cloth.through(np.zeros((0, 3))).shape == (0,)

    def test_through_is_the_fabric_formula(self, cloth: sp.Bsdf) -> None:
        theta = np.linspace(2.0, 55.0, 30)
        expected = [FABRIC.through(angle) for angle in np.radians(theta)]
        np.testing.assert_allclose(cloth.through(sp.direction(theta, 33.0)), expected, rtol=0.02)
        assert (cloth.through(sp.direction(theta), "off") == 0).all()

    def test_residual_and_peak_make_up_the_table(self, cloth: sp.Bsdf) -> None:
        # Over a whole column; T(w) itself is an interpolant, so that its mean over the column is meant.
        w_in = sp.direction(np.linspace(0, 60, 40), 10.0)
        evidence = cloth.evidence(w_in)
        rest = cloth.hemispherical(w_in, residual=True)
        np.testing.assert_allclose(rest + evidence.through, cloth.hemispherical(w_in), rtol=1e-5)
        assert (cloth.evaluate(w_in, -w_in, residual=True) < cloth.evaluate(w_in, -w_in)).all()

    def test_samples_carry_the_flux(self, cloth: sp.Bsdf) -> None:
        w_in = np.tile(sp.direction(30.0, 70.0), (40_000, 1))
        samples = cloth.sample(w_in, np.random.default_rng(5).random((40_000, 3)))
        one = w_in[:1]
        total = cloth.hemispherical(one, residual=True) + cloth.hemispherical(one, "reflection") + cloth.through(one)
        np.testing.assert_allclose(samples.weights.mean(axis=0), np.repeat(total, 3), rtol=0.01)
        straight = samples.kind == "straight"
        assert straight.mean() == pytest.approx((cloth.through(one) / total)[0], abs=0.01)
        np.testing.assert_allclose(samples.directions[straight], -w_in[straight])
        smooth = samples.kind == "smooth"
        np.testing.assert_allclose(samples.pdf[smooth], cloth.pdf(w_in[smooth], samples.directions[smooth]), rtol=1e-6)
        f = cloth.evaluate(w_in[smooth], samples.directions[smooth], residual=True)
        cosine = np.abs(samples.directions[smooth][:, 2])
        np.testing.assert_allclose(samples.weights[smooth][:, 1], f * cosine / samples.pdf[smooth], rtol=1e-6)

    @pytest.mark.parametrize("wrong", [[0, 0, 2], [0, 0, np.nan], [0, 0], [[[0, 0, 1]]]])
    def test_what_is_no_direction_is_refused(self, cloth: sp.Bsdf, wrong) -> None:
        with pytest.raises(sp.InputError, match="expected"):
            cloth.through(wrong)

    def test_names_that_are_not_known_are_refused(self, cloth: sp.Bsdf) -> None:
        with pytest.raises(sp.InputError, match="expected split, radiance, paper or off"):
            cloth.through([0, 0, 1], "sharp")
        with pytest.raises(sp.InputError, match="expected transmission or reflection"):
            cloth.hemispherical([0, 0, 1], "absorption")
        with pytest.raises(sp.InputError, match="go together"):
            cloth.evaluate(np.tile([0, 0, 1], (2, 1)), np.tile([0, 0, 1], (3, 1)))

    def test_missing_files_are_os_errors(self) -> None:
        with pytest.raises(FileNotFoundError) as caught:
            sp.Bsdf.load("nowhere.xml")
        assert caught.value.filename == "nowhere.xml"


class TestScene:
    def test_parse(self) -> None:
        scene = sp.Scene.parse(SPHERE + LAMP)
        assert scene.surfaces == ["furnace", "bulb"]
        assert scene.modifiers == ["white", "lamp"]

    def test_errors_have_file_line_and_column(self) -> None:
        with pytest.raises(sp.InputError, match=r"^room\.rad:2:1: "):
            sp.Scene.parse("void plastic a 0 0 5 .5 .5 .5 0 0\nb sphere s 0 0 4 0 0 0 1", name="room.rad")

    def test_search_path(self, tmp_path: Path) -> None:
        (tmp_path / "lamp.rad").write_text(LAMP)
        with pytest.raises(sp.InputError, match=r"lamp\.rad"):
            sp.Scene.parse("!xform lamp.rad")
        assert sp.Scene.parse("!xform lamp.rad", search_path=[tmp_path]).surfaces == ["bulb"]


class TestRender:
    def test_irradiance_of_a_sphere_lamp(self) -> None:
        """A sphere of radiance L and radius r at distance d: pi L (r / d)²."""
        found = sp.trace(sp.Scene.parse(LAMP), [[0, 0, 0]], [[0, 0, 2]], irradiance=True, samples=256)
        np.testing.assert_allclose(found[0], np.pi * np.array([10, 20, 30]) * (0.1 / 3) ** 2, rtol=5e-3)

    def test_radiance_along_rays(self) -> None:
        found = sp.trace(sp.Scene.parse(LAMP), [[0, 0, 0], [0, 0, 0]], [[0, 0, 1], [1, 0, 0]])
        np.testing.assert_allclose(found, [[10, 20, 30], [0, 0, 0]])

    def test_a_furnace_is_uniform(self) -> None:
        """In a closed sphere of reflectance 1/2 that emits 1 everywhere, radiance is 1 / (1 - 1/2)."""
        text = "void glow warm 0 0 4 1 1 1 0\nvoid plastic white 0 0 5 .5 .5 .5 0 0\n"
        outside = text + "warm source all 0 0 4 0 0 1 360\nwhite sphere ball 0 0 4 0 3 0 1\n"
        picture = sp.render(sp.Scene.parse(outside), sp.View.parse(FISHEYE), (24, 24), samples=256)
        ball = picture.luminance()[11:13, 11:13] / 179
        np.testing.assert_allclose(ball, 0.5, rtol=0.02)

    def test_progress_reaches_its_end(self) -> None:
        seen: list[tuple[int, int]] = []
        sp.render(
            sp.Scene.parse(SPHERE + LAMP),
            sp.View.parse(FISHEYE),
            (64, 64),
            samples=16,
            progress=lambda done, total: seen.append((done, total)),
        )
        assert seen
        assert seen[-1][0] == seen[-1][1] > 0

    def test_an_exception_in_the_callback_stops_the_work(self) -> None:
        def refuse(done: int, total: int) -> None:
            raise RuntimeError("enough")

        with pytest.raises(RuntimeError, match="enough"):
            sp.render(
                sp.Scene.parse(SPHERE + LAMP), sp.View.parse(FISHEYE), (400, 400), samples=10_000, progress=refuse
            )

    def test_other_threads_run_meanwhile(self) -> None:
        ticks = 0
        stop = threading.Event()

        def count() -> None:
            nonlocal ticks
            while not stop.wait(0.01):
                ticks += 1

        counter = threading.Thread(target=count)
        counter.start()
        sp.render(sp.Scene.parse(SPHERE + LAMP), sp.View.parse(FISHEYE), (64, 64), time=1.0)
        stop.set()
        counter.join()
        assert ticks > 20

    def test_seed_decides(self) -> None:
        world = sp.World.compile(sp.Scene.parse(SPHERE + LAMP))
        view = sp.View.parse(FISHEYE)
        pictures = [sp.render(world, view, (16, 16), samples=4, seed=seed).pixels for seed in (1, 1, 2)]
        np.testing.assert_array_equal(pictures[0], pictures[1])
        assert (pictures[0] != pictures[2]).any()

    def test_sensors_know_their_errors(self) -> None:
        """Two hundred equal sensors scatter as each of them states."""
        world = sp.World.compile(sp.Scene.parse(SPHERE + LAMP))
        points = np.zeros((200, 3))
        found = sp.trace(world, points, np.tile([0, 0, -1.0], (200, 1)), irradiance=True, samples=32, with_errors=True)
        assert found.shape == (200, 4)
        luminous = found[:, :3] @ LUMINANCE / 179
        stated = np.sqrt(np.mean(found[:, 3] ** 2))
        assert stated == pytest.approx(luminous.std(ddof=1), rel=0.2)
        few = sp.trace(world, points[:1], [[0, 0, -1.0]], irradiance=True, samples=4, with_errors=True)
        assert np.isnan(few[0, 3])

    def test_a_picture_knows_its_error(self) -> None:
        """Its blocks lie about the mean of many pictures as it states, and it ends when the goal is reached."""
        world, view = sp.World.compile(sp.Scene.parse(SPHERE + LAMP)), sp.View.parse(UPWARDS)
        pictures = [sp.render(world, view, (64, 64), error=0.15, seed=seed) for seed in range(12)]
        errors = [picture.error for picture in pictures]
        assert all(error is not None and error <= 0.15 for error in errors)
        blocks = np.array([p.luminance().reshape(16, 4, 16, 4).mean(axis=(1, 3)) for p in pictures])
        stated = np.array([picture.block_errors for picture in pictures])
        assert stated.shape == blocks.shape
        assert np.mean(stated**2) == pytest.approx(blocks.var(axis=0, ddof=1).mean(), rel=0.3)
        assert sp.render(world, view, (64, 64), samples=2).error is None

    @pytest.mark.parametrize("wrong", [{"samples": 0}, {"time": -1.0}, {"time": float("nan")}])
    def test_wrong_options_are_refused(self, wrong) -> None:
        with pytest.raises((sp.InputError, OverflowError)):
            sp.render(sp.Scene.parse(LAMP), sp.View.parse(FISHEYE), (4, 4), **wrong)


class TestPicture:
    def test_round_trip(self, tmp_path: Path) -> None:
        pixels = np.random.default_rng(1).random((7, 11, 3)).astype(np.float32)
        source = sp.ExactSource((0.0, 1.0, 0.0), 6.8e-5, (1e6, 2e6, 3e6), 0.75)
        made = sp.Picture.of(pixels, sp.View.parse(FISHEYE), header=["MADE_BY= a test"], exact_sources=[source])
        made.save(tmp_path / "a.hdr")
        read = sp.Picture.load(tmp_path / "a.hdr")
        # A pixel has eight bits below its largest channel.
        np.testing.assert_allclose(read.pixels, pixels, atol=1 / 256)
        assert read.shape == (7, 11)
        assert str(read.view) == str(made.view)
        assert "MADE_BY= a test" in read.header
        assert read.exact_sources == [source]
        np.testing.assert_allclose(read.luminance(), read.pixels @ LUMINANCE, rtol=1e-5)

    def test_glare_of_a_uniform_field(self) -> None:
        """A uniform hemisphere of luminance L gives Ev = pi L and no source: DGP = 5.87e-5 Ev + 0.16."""
        pixels = np.full((200, 200, 3), 500 / 179, dtype=np.float32)
        report = sp.glare(sp.Picture.of(pixels, sp.View.parse(FISHEYE)))
        assert report.ev_lux == pytest.approx(np.pi * 500, rel=2e-3)
        assert report.sources == []
        assert report.dgp == pytest.approx(5.87e-5 * np.pi * 500 + 0.16, rel=2e-3)
        assert report.to_dict()["dgp"] == report.dgp

    def test_an_exact_source_counts_with_its_size(self) -> None:
        luminance, omega = 1e6, 6.8e-5
        pixels = np.full((200, 200, 3), 100 / 179, dtype=np.float32)
        sun = sp.ExactSource((0.0, 1.0, 0.0), omega, (luminance / 179,) * 3, 1.0)
        report = sp.glare(sp.Picture.of(pixels, sp.View.parse(FISHEYE), exact_sources=[sun]))
        assert [source.exact for source in report.sources] == [True]
        ev = report.ev_lux
        expected = 5.87e-5 * ev + 0.0918 * np.log10(1 + luminance**2 * omega / ev**1.87) + 0.16
        assert report.dgp == pytest.approx(expected, abs=1e-3)

    def test_rules_by_name_and_one_by_one(self) -> None:
        """Two lamps: above and below 2000 cd/m², both above 5 times the mean of a dark task."""
        view = sp.View.parse(FISHEYE)
        directions = view.rays(300, 300).directions
        luminance = np.full((300, 300), 50.0)
        for azimuth, value in ((20, 9000.0), (-20, 1500.0)):
            lamp = [np.sin(np.radians(azimuth)), np.cos(np.radians(azimuth)), 0.0]
            luminance[directions @ np.array(lamp) > np.cos(np.radians(4))] = value
        picture = sp.Picture.of(np.repeat(luminance[..., None] / 179, 3, axis=2), view)
        assert len(sp.glare(picture).sources) == 1
        task = sp.Task.at(view, 0, -30, 20)
        old = sp.glare(picture, rules="wienold-2006", task=task)
        assert (len(old.sources), old.threshold_cd_m2) == (2, pytest.approx(250))
        assert old.zones.task_cd_m2 == pytest.approx(50)
        assert old.zones.ratios_to_task()["task"] == 1
        own = sp.glare(picture, rules=sp.GlareRules(threshold_cd_m2=1000, threshold_times_mean=None))
        assert len(own.sources) == 2
        assert own.dgp == pytest.approx(own.dgp_offset + own.dgp_ev_term + sum(s.dgp_part for s in own.sources))
        wider = sp.glare(picture, least_solid_angle_sr=0.1)
        assert wider.sources[0].solid_angle_sr == pytest.approx(0.1)
        assert wider.sources[0].illuminance_lux == sp.glare(picture).sources[0].illuminance_lux
        assert sp.glare(picture, ev_lux=900).edgps == sp.glare(picture, ev_lux=900).dgp
        with pytest.raises(sp.InputError, match="wienold-2006"):
            sp.glare(picture, rules="mine")  # type: ignore[arg-type]

    def test_a_picture_without_view_cannot_glare(self) -> None:
        with pytest.raises(sp.InputError, match="view"):
            sp.glare(sp.Picture.of(np.ones((4, 4, 3))))


class TestSky:
    def test_sun_position_of_a_solstice(self) -> None:
        """At noon of the June solstice the sun stands at 90 - latitude + 23.44 degrees, in the south."""
        noon = datetime(2024, 6, 20, 12, 2, tzinfo=UTC)
        altitude, azimuth = sp.sun_position(sp.Place(51.48, 0.0), noon)
        assert altitude == pytest.approx(90 - 51.48 + 23.44, abs=0.05)
        assert azimuth == pytest.approx(180.0, abs=1.0)

    def test_east_is_positive(self) -> None:
        """The sun comes from the east: the same moment is later in the day there."""
        moment = datetime(2024, 3, 20, 9, 0, tzinfo=timezone(timedelta(hours=1)))
        assert (
            sp.sun_position(sp.Place(45, 15), moment).azimuth_deg > sp.sun_position(sp.Place(45, 5), moment).azimuth_deg
        )

    def test_times_need_a_zone(self) -> None:
        with pytest.raises(sp.InputError, match="time zone"):
            sp.sun_position(sp.Place(45, 15), datetime(2024, 3, 20, 9, 0))

    def test_epw_row(self, shared: Path) -> None:
        """Hour 15 of 21 March in Oakland: the sun of 14:30 PST by spherical trigonometry.

        Declination 0.3 degrees, equation of time -7.3 minutes (Astronomical Almanac, 21 March).
        """
        epw = next((shared / "weather").glob("*.epw"))
        sky = sp.Sky.from_epw(epw, 3, 21, 15)
        latitude, declination = np.radians([37.72, 0.3])
        hour_angle = np.radians((14.5 - 7.3 / 60 - 12) * 15 - (122.22 - 120))
        sine = np.sin(latitude) * np.sin(declination) + np.cos(latitude) * np.cos(declination) * np.cos(hour_angle)
        west = np.cos(declination) * np.sin(hour_angle)
        assert sky.sun_direction[2] == pytest.approx(sine, abs=0.005)
        assert -sky.sun_direction[0] == pytest.approx(west, abs=0.005)
        assert sky.sun_direction[1] < 0

    @given(st.floats(1, 85), st.floats(0, 360), st.floats(0, 900), st.floats(5, 400))
    @settings(max_examples=50, deadline=None)
    def test_text_says_what_the_sky_is(self, altitude: float, azimuth: float, direct: float, diffuse: float) -> None:
        sky = sp.Sky.perez((altitude, azimuth), direct, diffuse)
        scene = sp.Scene.parse(sky.to_radiance())
        assert scene.surfaces[-2:] == ["sky", "ground"]
        assert sky.direct_normal_lux >= 0
        assert (sky.sun_direction is None) == (sky.direct_normal_lux == 0)


class TestFiles:
    def test_whole_or_not_at_all(self, tmp_path: Path) -> None:
        target = tmp_path / "a.txt"
        target.write_text("before")

        def fail() -> None:
            with whole_file(target) as temporary:
                temporary.write_text("half")
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            fail()
        assert target.read_text() == "before"
        assert list(tmp_path.iterdir()) == [target]
