"""The servo in Python: against the closed form of a wall, and never run by Python."""

import threading
import time
import unittest

import numpy as np
import palpate


def wait_until(ready, seconds=60.0):
    """Whether it came true; generously, for machines that are busy."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if ready():
            return True
        time.sleep(0.005)
    return False


def wall(at=0.0, **settings):
    """Free where x < at, in metres."""
    return palpate.Chain([palpate.Plane([at, 0, 0], [-1, 0, 0])], scale=1.0, settings={"stiffness": 400, **settings})


class Servo(unittest.TestCase):
    def test_a_led_hand_is_held_by_a_wall(self):
        with palpate.Servo(palpate.Device.led(), wall()) as servo:
            servo.lead([-0.002, 0, 0])
            self.assertTrue(wait_until(lambda: servo.now().present))

            def pressed():
                servo.lead([0.004, 0, 0])
                now = servo.now()
                return abs(now.probe[0] - 0.004) < 1e-9 and abs(now.force[0] + 400 * 0.004) < 1e-3

            self.assertTrue(wait_until(pressed), servo.now().force)
            self.assertAlmostEqual(servo.now().proxy[0], 0.0, places=12)
            self.assertEqual(palpate.STATES[servo.now().state_code], "held")
            servo.force_off()
            self.assertTrue(wait_until(lambda: servo.now().force == [0.0, 0.0, 0.0] and not servo.now().armed))

    def test_steps_are_those_that_were_taken(self):
        path = np.linspace([-0.01, 0, 0], [0.005, 0, 0], 301)
        with palpate.Servo(palpate.Device.path(path), wall()) as servo:
            parts = []

            def played():
                parts.append(servo.steps())
                return sum(map(len, parts)) > 0 and len(parts[-1]) > 0 and parts[-1].probes[-1, 0] == 0.005

            self.assertTrue(wait_until(played))
            now = servo.now()
        times = np.concatenate([part.times for part in parts])
        probes = np.concatenate([part.probes for part in parts])
        proxies = np.concatenate([part.proxies for part in parts])[:, 0]
        self.assertEqual(now.dropped, 0)
        self.assertTrue((np.diff(times) > 0).all())
        np.testing.assert_allclose(proxies[:, 0], np.minimum(probes[:, 0], 0.0), atol=1e-12)

    def test_a_busy_python_does_not_hold_it_up(self):
        """Steps go on while this thread holds Python's lock: a servo that ran Python would stand still."""
        with palpate.Servo(palpate.Device.simulated(hand="firm"), wall()) as servo:
            self.assertTrue(wait_until(lambda: servo.now().steps > 10))
            before = servo.now().steps
            end = time.monotonic() + 1.0
            # One call of C that does not let go of the lock, again and again.
            block = bytes(1 << 20)
            while time.monotonic() < end:
                block.count(b"\1")
            self.assertGreater(servo.now().steps, before + 100)

    def test_chains_of_arrays_are_swapped_while_it_runs(self):
        values = np.zeros((5, 5, 5))
        with palpate.Servo(palpate.Device.led(), wall()) as servo:
            servo.lead([0, 0, 0])
            for i in range(50):
                field = palpate.scalar(values + i, [0.01] * 3, [-0.02] * 3)
                servo.set_chain(palpate.Chain([palpate.Potential(field)], scale=1.0))
                time.sleep(0.002)
                servo.now()
            with self.assertRaisesRegex(palpate.UsageError, "same scale"):
                servo.set_chain(palpate.Chain([palpate.Drag()], scale=2.0))

    def test_what_cannot_be_is_refused(self):
        with self.assertRaisesRegex(palpate.UsageError, "premium"):
            palpate.Device.simulated(profile="no such arm")
        with self.assertRaisesRegex(palpate.UsageError, "as many times"):
            palpate.Device.path([[0, 0, 0]], [0, 1])
        with self.assertRaises(palpate.UsageError):
            palpate.Servo(palpate.Device.led(), wall(), rate=3.0)
        servo = palpate.Servo(palpate.Device.path([[0, 0, 0]]), wall())
        with self.assertRaisesRegex(palpate.UsageError, "follows a path"):
            servo.lead([0, 0, 0])
        servo.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            servo.now()

    def test_it_may_end_anywhere(self):
        servo = palpate.Servo(palpate.Device.simulated(), wall())
        thread = threading.Thread(target=servo.close)
        thread.start()
        thread.join()
        palpate.Servo(palpate.Device.simulated(), wall())  # ends with the object


if __name__ == "__main__":
    unittest.main()
