"""Motions: fields, states, frames and derivatives."""
import unittest

import support
from support import np, slender

STEPS, DT = 12, 1e-3


def swing(t: float) -> tuple[float, float, float]:
    return 0, 0, 5e-3 * np.sin(300 * t)


class Motions(support.TestCase):
    def test_fields(self) -> None:
        """A function is asked at the ends of steps; None is the scene's field over time."""
        model = support.model_of()
        rows = np.array([swing((n + 1) * DT) for n in range(STEPS)])
        by_function, by_rows = (model.simulate(steps=STEPS, dt=DT, field=field) for field in (swing, rows))
        self.same(by_function.states[STEPS].x, by_rows.states[STEPS].x)
        formula = support.model_of(job="simulate", time={"step": DT, "steps": STEPS},
                                   flux_density={"formula": ["0", "0", "5e-3*sin(300*t)"]})
        self.near(formula.simulate(steps=STEPS, dt=DT).states[-1].x, by_rows.states[-1].x, 1e-12)
        steady = model.simulate(steps=STEPS, dt=DT, field=[0, 0, 5e-3])
        self.same(model.simulate(steps=STEPS, dt=DT).states[-1].x, steady.states[-1].x)
        self.refuses(ValueError, r"\[steps, 3\], \(12, 3\)", model.simulate, steps=STEPS, dt=DT, field=np.zeros((4, 3)))
        self.refuses(slender.Error, "longer than 0 s", model.simulate, steps=1, dt=0)

    def test_states(self) -> None:
        """Going on from a state in the middle is the same motion."""
        model = support.model_of()
        whole = model.simulate(steps=STEPS, dt=DT)
        self.assertEqual((whole.steps, len(whole.states), whole.status), (STEPS, STEPS + 1, "done"))
        middle = whole.states[5]
        self.near(middle.time, 5 * DT, 1e-12)
        self.near(middle.v, (middle.x - whole.states[4].x) / DT, 1e-9)
        rest = model.simulate(middle, steps=STEPS - 5, dt=DT)
        self.near(rest.states[-1].x, whole.states[-1].x, 1e-10)
        self.same([state.x for state in whole.states[-2:]][1], whole.states[STEPS].x)
        self.refuses(IndexError, "out of range", lambda: whole.states[STEPS + 1])

    def test_frames(self) -> None:
        model, seen = support.model_of(), []
        motion = model.simulate(steps=3, dt=DT, on_frame=lambda time, x: seen.append((time, x)))
        self.assertEqual(len(seen), 3)
        for n, (time, x) in enumerate(seen):
            self.near(time, (n + 1) * DT, 1e-12)
            self.same(x, motion.states[n + 1].x)

    def test_derivatives(self) -> None:
        model = support.model_of()
        field = np.array([swing((n + 1) * DT) for n in range(STEPS)])
        start = model.state()
        motion = model.simulate(start, steps=STEPS, dt=DT, field=field)
        dF = {5: np.ones((model.points, 3)), STEPS: 2 * (motion.states[STEPS].x - model.rest)}
        dp, dfield, (dx, dv) = motion.vjp(dF, start=True)
        self.assertIsNotNone(dfield)
        assert dfield is not None
        self.same(motion.vjp(dF)[0]["magnetization"], dp["magnetization"])
        r = np.random.default_rng(2)
        free = np.abs(model.rest[:, :1]) > 1e-9
        d = {"M": r.normal(0, 10, dp["magnetization"].shape), "B": r.normal(0, 1e-6, field.shape),
             "x": 1e-7 * free * r.normal(size=dx.shape), "v": 1e-6 * free * r.normal(size=dv.shape)}
        slope = sum(np.sum(a * d[key]) for key, a in
                    {"M": dp["magnetization"], "B": dfield, "x": dx, "v": dv}.items())
        tangent = motion.jvp({"magnetization": d["M"]}, d["B"], d["x"], d["v"])
        self.assertEqual(tangent.shape, (STEPS + 1, model.points, 3))
        self.near(sum(np.sum(seed * tangent[n]) for n, seed in dF.items()), slope, 1e-9)
        F = []
        for side in (1, -2):
            model.params["magnetization"][:] += side * d["M"]
            start.x[:] += side * d["x"]
            start.v[:] += side * d["v"]
            field += side * d["B"]
            moved = model.simulate(start, steps=STEPS, dt=DT, field=field)
            F.append(moved.states[5].x.sum() + np.sum((moved.states[STEPS].x - model.rest) ** 2))
        self.near((F[0] - F[1]) / 2, slope, 1e-5)

    def test_velocities(self) -> None:
        """Of F(v_n): by differences in the magnetisation; of the start's, itself."""
        model = support.model_of()
        motion = model.simulate(steps=4, dt=DT)
        dv = np.random.default_rng(3).normal(size=(model.points, 3))
        dv[np.abs(model.rest[:, 0]) < 1e-9] = 0  # held
        slope, F = motion.vjp({}, {4: dv})[0]["magnetization"].sum(), []
        for side in (1, -2):
            model.params["magnetization"][:] += side * 10
            F.append(np.sum(dv * model.simulate(steps=4, dt=DT).states[4].v))
        self.near((F[0] - F[1]) / 20, slope, 1e-6)
        start = motion.vjp({}, {0: dv}, start=True)[2]
        self.same(start.v, dv)
        self.same(start.x, np.zeros(dv.shape))

    def test_a_chain_of_motions(self) -> None:
        """Of motions of one step each, one after the other, as of one motion."""
        model = support.model_of()
        field = np.array([swing((n + 1) * DT) for n in range(STEPS)])
        motion = model.simulate(steps=STEPS, dt=DT, field=field)
        dF = {STEPS: np.ones((model.points, 3))}
        dp, dfield, (x0, v0) = motion.vjp(dF, start=True)
        state, chain = model.state(), []
        for row in field:
            chain.append(model.simulate(state, steps=1, dt=DT, field=row))
            state = chain[-1].states[1]
        x, v, rows, dM = model.dofs_of(dF[STEPS]), np.zeros(model.dofs), [], np.zeros((24, 3))
        for one in reversed(chain):
            dp1, row1, (x, v) = one.vjp({1: x}, {1: v}, start=True, dofs=True)
            rows.append(row1)
            dM += dp1["magnetization"]
        assert dfield is not None
        self.near(np.concatenate(rows[::-1]), dfield, 1e-7)
        self.near(dM, dp["magnetization"], 1e-7)
        self.near(model.places(x), x0, 1e-7)
        self.near(model.places(v), v0, 1e-7)

    def test_derivatives_without_a_field(self) -> None:
        model = support.model_of()
        motion = model.simulate(steps=4, dt=DT)
        dp, dfield = motion.vjp({4: np.ones((model.points, 3))})
        self.assertIsNone(dfield)
        self.assertGreater(np.abs(dp["flux_density"]).max(), 0)
        self.refuses(slender.Error, "no state after 5 steps", motion.vjp, {5: np.ones((model.points, 3))})
        self.refuses(ValueError, r"dF\[2\] has the shape", motion.vjp, {2: np.ones(3)})
        self.same(motion.vjp({})[0]["young"], np.zeros(24))

    def test_numbers_that_c_would_cut(self) -> None:
        model = support.model_of()
        motion = model.simulate(steps=3, dt=1e-3)
        dF = np.ones((model.points, 3))
        for key in (1.5, "2"):
            self.refuses(TypeError, "", motion.vjp, {key: dF})
        for key in (2**32 + 2, 2**40):
            self.refuses(ValueError, "out of all bounds", motion.vjp, {key: dF})
        self.refuses(slender.Error, "no state after 4 steps", motion.vjp, {4: dF})
        self.refuses(ValueError, "out of all bounds", model.simulate, steps=2**32 + 3, dt=1e-3)
        for steps in (-1, 2**31 - 1):
            self.refuses(slender.Error, "they must be 0 to", model.simulate, steps=steps, dt=1e-3)
        self.refuses(slender.Error, "memory is nan", model.simulate, steps=3, dt=1e-3, memory=float("nan"))
        self.assertEqual(model.equilibrium().status, "converged")  # nothing is lost

    def test_what_does_not_converge(self) -> None:
        model = support.model_of(solver={"max_iterations": 1})
        model.params["magnetization"][:] *= 1e6
        motion = model.simulate(steps=3, dt=1e-2)
        self.assertEqual((motion.status, len(motion.states)), ("not converged", motion.steps + 1))
        self.assertIn("step", motion.message)
        self.refuses(slender.NotConverged, "step", model.simulate, steps=3, dt=1e-2, check=True)


if __name__ == "__main__":
    unittest.main()
