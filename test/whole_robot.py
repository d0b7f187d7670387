"""The whole simulated robot, as users start it, and a ROS master of its own."""
import atexit
import os
import signal
import socket
import subprocess
import time
import xmlrpc.client

from nav_msgs.msg import Odometry
from std_msgs.msg import String

from recording import Collector, Diagnostics

IMU = (-0.06, 0.02)  # where the map begins, seen from the base at the first start [m]


class Master:
    """A ROS master that this process uses from now on. To be made before the first node."""

    def __init__(self):
        with socket.socket() as free:
            free.bind(("localhost", 0))
            self._port = free.getsockname()[1]
        os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % self._port
        self.start()

    def start(self):
        self._process = subprocess.Popen(["roscore", "-p", str(self._port)],
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        atexit.register(self._process.kill)
        self._wait_for_answer()
        self._proxy().setParam("/test", "/use_sim_time", True)

    def stop(self):
        """With everything it knows."""
        self._process.send_signal(signal.SIGINT)
        self._process.wait(30)

    def _proxy(self):
        return xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"])

    def _wait_for_answer(self):
        for _ in range(300):
            try:
                self._proxy().getPid("/test")
                return
            except OSError:
                time.sleep(0.1)
        raise AssertionError("the master does not start")


class Robot:
    """Everything of the robot, running: hv_liom.launch in simulation with these arguments."""

    def __init__(self, log, start, *arguments, keep=None):
        """`start` is where the base is at first: x, y [m] and yaw [deg] in the building; None:
        anywhere. `keep`: of the true poses; None: all."""
        place = ["start:=%g, %g, 0, %g" % tuple(start)] if start else []
        self._file = open(log, "w")
        self._log = log
        self._process = subprocess.Popen(
            ["roslaunch", "hv_bringup", "hv_liom.launch", "sim:=true"] + place + list(arguments),
            stdout=self._file, stderr=subprocess.STDOUT)
        atexit.register(self.switch_off)
        self.truth = Collector("/truth/odometry", Odometry, keep)
        self.collisions = Collector("/collision", String)
        self.diagnostics = Diagnostics()

    def here(self):
        """x, y in the building."""
        return place_of(self.truth.messages[-1].pose.pose)

    def is_on(self):
        return self._process.poll() is None

    def switch_off(self):
        """The same when it is off already."""
        self._process.send_signal(signal.SIGINT)
        self._process.wait(60)
        self._file.close()

    def output(self):
        with open(self._log) as file:
            return file.read()


def place_of(pose):
    return (pose.position.x, pose.position.y)
