#!/usr/bin/python3
"""Localisation as a nodelet beside that of the odometry."""
import os
import sys
import unittest

import roslib.packages
import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from localization import (  # noqa: E402
    KIDNAPPED, MAP, STATE, Places, play_slowly, wait_for_nodes)
from mapping import interrupt, start_node  # noqa: E402
from recording import CONFIG, Diagnostics, Player, odometry_collector, wait_until  # noqa: E402


class LocalizationNodelet(unittest.TestCase):

    def test_the_place_is_found(self):
        self.diagnostics = Diagnostics()
        self.odometry = odometry_collector()
        self.places = Places()
        self.player = Player(KIDNAPPED)
        # Its parameter is a path that only the test knows.
        rospy.set_param("/hv_relocalize_ndt/map", MAP)
        rospy.set_param("/hv_relocalize_ndt/config_file", CONFIG)
        program = roslib.packages.find_node("nodelet", "nodelet")[0]
        loader = start_node(program, "hv_relocalize_ndt", "load",
                            "hv_relocalize_ndt/LocalizationNodelet", "manager")
        wait_for_nodes(self)
        play_slowly(self, self.player.clouds(0, 40))
        self.assertGreater(len(self.places), 10)
        self.assertTrue(wait_until(
            lambda: self.diagnostics.value(STATE, "state") == "tracking"))
        interrupt(loader, "hv_relocalize_ndt")


if __name__ == "__main__":
    rospy.init_node("localization_nodelet_test")
    rostest.rosrun("hv_bringup", "localization_nodelet", LocalizationNodelet)
