#!/usr/bin/python3
"""Maps that the nodes save: equal to those of hv_slam, on request, at exit, and continued."""
import os
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from hv_msgs.msg import SaveMapActionFeedback, SaveMapActionGoal, SaveMapActionResult
from std_srvs.srv import Trigger

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mapping import LOOPS, Mapping, contents_of, edges_of, files_of, poses_of  # noqa: E402
from recording import CONFIG, HV_SLAM, LOOP_RECORDING, Collector, wait_until  # noqa: E402
from small_disk import SmallDisk, is_permitted  # noqa: E402

WHOLE_MAP = {"cloud.pcd", "descriptors.bin", "graph.g2o", "grid.pgm", "grid.yaml", "manifest.yaml",
             "occupancy.bt", "poses.tum"}


class SaveMap:
    """A client of the action."""

    def __init__(self):
        self._goals = rospy.Publisher("/hv_loop_btc/save_map/goal", SaveMapActionGoal, queue_size=5)
        self.feedback = Collector("/hv_loop_btc/save_map/feedback", SaveMapActionFeedback)
        self.results = Collector("/hv_loop_btc/save_map/result", SaveMapActionResult)
        assert wait_until(lambda: self._goals.get_num_connections() > 0
                          and self.results.connected() and self.feedback.connected())

    def save(self, directory):
        """Status and result of saving to `directory`."""
        before = len(self.results)
        goal = SaveMapActionGoal()
        goal.goal.directory = directory
        self._goals.publish(goal)
        assert wait_until(lambda: len(self.results) > before)
        answer = self.results.messages[-1]
        return answer.status.status, answer.result


class MappingSave(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.map = os.path.join(self.folder.name, "new", "map")

    def tearDown(self):
        self.folder.cleanup()

    def offline_map(self):
        out = os.path.join(self.folder.name, "offline")
        subprocess.run([HV_SLAM, "--config", CONFIG, "--bag", LOOP_RECORDING, "--out", out],
                       check=True, stdout=subprocess.DEVNULL)
        return os.path.join(out, "map")

    def expect_whole_map(self, folder):
        self.assertTrue(WHOLE_MAP.issubset(files_of(folder)), files_of(folder))

    def expect_near(self, poses, references, tolerance):
        self.assertEqual(sorted(poses), sorted(references))
        worst = max(abs(value - reference) for stamp in poses
                    for value, reference in zip(poses[stamp][:3], references[stamp][:3]))
        self.assertLess(worst, tolerance)

    def test_1_interrupt_saves_the_map_of_hv_slam(self):
        mapping = Mapping("_map_path:=" + self.map)
        mapping.play()
        output = mapping.stop()
        self.assertIn("map saved in " + self.map, output)
        self.expect_whole_map(self.map)
        self.assertEqual(os.listdir(os.path.dirname(self.map)), ["map"])
        offline = self.offline_map()
        self.assertEqual(edges_of(self.map), edges_of(offline))
        self.assertGreaterEqual(sum(kind == "loop" for kind, _, _ in edges_of(self.map)), 3)
        self.expect_near(poses_of(self.map), poses_of(offline), 1e-3)
        for name in files_of(os.path.join(offline, "keyframes")):
            with open(os.path.join(offline, "keyframes", name), "rb") as file:
                expected = file.read()
            with open(os.path.join(self.map, "keyframes", name), "rb") as file:
                self.assertEqual(file.read(), expected, name)

    def test_2_saves_on_request_while_running(self):
        mapping = Mapping("_map_path:=" + self.map, "_mapping/autosave:=false")
        service = rospy.ServiceProxy("/hv_loop_btc/save_map", Trigger)
        action = SaveMap()
        answer = service()
        self.assertFalse(answer.success)
        self.assertIn("no keyframe", answer.message)
        mapping.play(mapping.player.clouds(0, 100))

        answer = service()
        self.assertTrue(answer.success, answer.message)
        self.assertIn(self.map, answer.message)
        self.expect_whole_map(self.map)
        keyframes = len(poses_of(self.map))
        self.assertEqual(keyframes, len(mapping.keyframes))

        other = os.path.join(self.folder.name, "other")
        status, result = action.save(other)
        self.assertEqual(status, GoalStatus.SUCCEEDED)
        self.assertTrue(result.success, result.message)
        self.assertEqual(result.directory, other)
        self.assertGreater(result.points, 1000)
        size = sum(os.path.getsize(os.path.join(other, name)) for name in files_of(other)
                   if name != "manifest.yaml")
        self.assertEqual(result.bytes, size)
        stages = [message.feedback.stage for message in action.feedback.messages]
        self.assertIn("cloud and grid", stages)

        for directory, reason in (("relative/map", "absolute"), ("/proc/map", "/proc/map"),
                                  (CONFIG, "is a file")):
            status, result = action.save(directory)
            self.assertEqual(status, GoalStatus.ABORTED)
            self.assertFalse(result.success)
            self.assertIn(reason, result.message)
        self.assertTrue(mapping.is_running())
        self.assertTrue(wait_until(
            lambda: "map not saved" in mapping.diagnostics.message("map")))

        mapping.play(mapping.player.clouds(100, 150))
        self.assertGreater(len(mapping.keyframes), keyframes)
        mapping.stop()
        self.assertEqual(len(poses_of(self.map)), keyframes)  # no autosave

    def test_3_continues_a_map(self):
        mapping = Mapping("_map_path:=" + self.map)
        mapping.play()
        mapping.stop()
        first = poses_of(self.map)

        mapping = Mapping("_map_path:=" + self.map, "_continue_map:=" + self.map)
        self.assertEqual(mapping.diagnostics.value(LOOPS, "joined"), "not joined yet")
        self.assertEqual(mapping.count("keyframes of the continued map"), len(first))
        later = mapping.player.clouds(170)
        mapping.play(later)
        self.assertEqual(mapping.diagnostics.value(LOOPS, "joined"), "yes")
        second_keyframes = list(mapping.keyframes.messages)
        output = mapping.stop()
        self.assertIn("joined", output)
        both = edges_of(self.map)
        bridges = [edge for edge in both if edge[0] == "loop" and edge[1] < len(first) <= edge[2]]
        self.assertGreaterEqual(len(bridges), 2)
        # The second session drives where the first did: the same stamps, the same places.
        self.expect_second_session_on_the_first(first, second_keyframes)

    def expect_second_session_on_the_first(self, first, keyframes):
        with open(os.path.join(self.map, "graph.g2o")) as file:
            places = {int(words[1]): [float(value) for value in words[2:5]]
                      for words in (line.split() for line in file) if words[0] == "VERTEX_SE3:QUAT"}
        # An odometry that starts in motion needs some keyframes to settle.
        known = sorted((float(stamp), pose[:3]) for stamp, pose in first.items())
        for keyframe in keyframes[5:]:
            place = places[len(first) + keyframe.id]
            stamp = keyframe.header.stamp.to_sec()
            nearest = min(known, key=lambda other: abs(other[0] - stamp))
            if abs(nearest[0] - stamp) > 0.15:
                continue
            distance = sum((a - b) ** 2 for a, b in zip(place, nearest[1])) ** 0.5
            self.assertLess(distance, 0.1, stamp)

    def test_4_a_full_disk_costs_no_map(self):
        if not is_permitted():
            self.skipTest("not permitted to mount a small disk")
        disk = SmallDisk(os.path.join(self.folder.name, "disk"), megabytes=64)
        path = os.path.join(disk.path, "map")
        mapping = Mapping("_map_path:=" + path, prefix=disk.prefix)
        disk.enter(mapping.pid)
        action = SaveMap()
        mapping.play(mapping.player.clouds(0, 80))
        self.assertEqual(action.save(path)[0], GoalStatus.SUCCEEDED)
        saved = contents_of(disk.inside(path))
        mapping.play(mapping.player.clouds(80, 120))

        disk.fill(but_bytes=1 << 16)
        self.expect_not_saved(action, disk, path, "No space left on device")
        self.assertEqual(contents_of(disk.inside(path)), saved)
        self.assertTrue(wait_until(
            lambda: "map not saved" in mapping.diagnostics.message("map")))
        disk.empty()
        disk.remount("ro")
        self.expect_not_saved(action, disk, path, "Read-only file system")
        self.assertEqual(contents_of(disk.inside(path)), saved)

        disk.remount("rw")
        mapping.play(mapping.player.clouds(120, 160))
        self.assertEqual(action.save(path)[0], GoalStatus.SUCCEEDED)
        self.assertEqual(len(poses_of(disk.inside(path))), len(mapping.keyframes))
        self.assertIn("map saved in " + path, mapping.stop())

    def expect_not_saved(self, action, disk, path, reason):
        status, result = action.save(path)
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertFalse(result.success)
        self.assertIn(disk.path, result.message)
        self.assertIn(reason, result.message)
        self.assertNotIn("\n", result.message)


if __name__ == "__main__":
    rospy.init_node("mapping_save_test")
    rostest.rosrun("hv_bringup", "mapping_save", MappingSave)
