"""Odometry and loop closing nodes under test, and the maps that they save."""
import atexit
import os
import signal
import subprocess

import rospy

from recording import (
    CONFIG, HV_LIO_NODE, HV_LOOP_BTC_NODE, LOOP_RECORDING, POINTS, Collector, Diagnostics, Player,
    odometry_collector, wait_until)
from hv_msgs.msg import Keyframe

CONNECTING_S = 1.5  # of a node whose predecessor nobody has missed yet
LOOPS = "loop closing"  # name of the status in the diagnostics


def start_node(program, name, *arguments, prefix=()):
    """A process that does not outlive the tests, whatever becomes of them."""
    process = subprocess.Popen([*prefix, program, "__name:=" + name, *arguments],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    atexit.register(process.kill)
    return process


def interrupt(process, name):
    """What the node has said, after an interrupt; its parameters are removed."""
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=15)
    if rospy.has_param("/" + name):
        rospy.delete_param("/" + name)
    assert process.returncode == 0, output
    return output


def start_odometry():
    return start_node(HV_LIO_NODE, "hv_lio", "_config_file:=" + CONFIG)


def start_mapping(*arguments, prefix=()):
    return start_node(HV_LOOP_BTC_NODE, "hv_loop_btc", "_config_file:=" + CONFIG, *arguments,
                      prefix=prefix)


def kill(process):
    """At once, without a word."""
    process.kill()
    process.communicate(timeout=15)


def restart_odometry(process):
    """The process in the place of one that is killed; returns when it hears and is heard."""
    kill(process)
    heard = Diagnostics()
    process = start_odometry()
    assert wait_until(lambda: heard.value("input", "scans") == "0")
    rospy.rostime.wallsleep(CONNECTING_S)
    return process


def is_ready(diagnostics):
    """Whether the loop closing node hears the odometry."""
    described = diagnostics.value(LOOPS, "keyframes") != ""
    return described and "nobody publishes" not in diagnostics.message(LOOPS)


def settle(odometry, keyframes, diagnostics):
    """Waits until no more odometry comes and every keyframe has been taken in."""
    count = -1
    while count != len(odometry):
        count = len(odometry)
        rospy.rostime.wallsleep(1.0)

    def taken():
        continued = diagnostics.count("keyframes of the continued map", LOOPS)
        return diagnostics.count("keyframes", LOOPS) - continued
    assert wait_until(lambda: taken() == len(keyframes)), (taken(), len(keyframes))


class Mapping:
    """A fresh pair of nodes that maps a recording which the test plays."""

    def __init__(self, *arguments, prefix=()):
        self.diagnostics = Diagnostics()
        self.odometry = odometry_collector()
        self.keyframes = Collector("/keyframe", Keyframe)
        self.player = Player(LOOP_RECORDING)
        self._lio = start_odometry()
        self._loop = start_mapping(*arguments, prefix=prefix)
        assert self.player.wait_for_node()
        assert wait_until(self.odometry.connected) and wait_until(self.keyframes.connected)
        assert wait_until(lambda: is_ready(self.diagnostics))

    def count(self, key):
        return self.diagnostics.count(key, LOOPS)

    def play(self, messages=None):
        """Plays, and waits until every keyframe has been taken in."""
        messages = self.player.messages if messages is None else messages
        sent = sum(topic == POINTS for topic, _ in messages)
        before = len(self.odometry)
        self.player.play(messages, lambda: len(self.odometry))
        assert wait_until(lambda: len(self.odometry) - before > 0.75 * sent), len(self.odometry)
        settle(self.odometry, self.keyframes, self.diagnostics)

    def restart_odometry(self):
        self._lio = restart_odometry(self._lio)

    def kill_mapping(self):
        kill(self._loop)

    def start_mapping(self, *arguments):
        """After it was killed."""
        heard = Diagnostics()
        self._loop = start_mapping(*arguments)
        assert wait_until(lambda: is_ready(heard))
        rospy.rostime.wallsleep(CONNECTING_S)

    @property
    def pid(self):
        """Of the loop closing node."""
        return self._loop.pid

    def is_running(self):
        return self._loop.poll() is None

    def stop(self):
        """Interrupts both nodes; returns what loop closing has said."""
        interrupt(self._lio, "hv_lio")
        output = interrupt(self._loop, "hv_loop_btc")
        self.player.close()
        return output


def files_of(folder):
    """Relative paths of all files."""
    return sorted(os.path.relpath(os.path.join(base, name), folder)
                  for base, _, names in os.walk(folder) for name in names)


def contents_of(folder):
    """Relative path -> bytes of all files."""
    contents = {}
    for name in files_of(folder):
        with open(os.path.join(folder, name), "rb") as file:
            contents[name] = file.read()
    return contents


def poses_of(map_folder):
    """Stamp text -> x y z qx qy qz qw."""
    with open(os.path.join(map_folder, "poses.tum")) as file:
        rows = [line.split() for line in file if not line.startswith("#")]
    return {row[0]: [float(value) for value in row[1:]] for row in rows}


def edges_of(map_folder):
    """(kind, from, to) of every edge; kind is odometry, loop, or rejected."""
    edges = []
    kind = ""
    with open(os.path.join(map_folder, "graph.g2o")) as file:
        for words in (line.split() for line in file):
            if words[0] in ("#odometry", "#loop"):
                kind = words[0][1:]
            elif words[0] == "EDGE_SE3:QUAT":
                edges.append((kind, int(words[1]), int(words[2])))
            elif words[0] == "#rejected":
                edges.append(("rejected", int(words[2]), int(words[3])))
    return sorted(edges)
