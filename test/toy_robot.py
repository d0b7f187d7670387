"""A robot in a toy building that stands in for mapping, navigation and localisation: it publishes
`map` and tf, and serves the action `move_base`."""
import math
import threading

import actionlib
import numpy
import rospy
from geometry_msgs.msg import TransformStamped
from move_base_msgs.msg import MoveBaseAction
from nav_msgs.msg import OccupancyGrid
from tf2_msgs.msg import TFMessage

CELL_M = 0.1
SIGHT_M = 4.0
STEP_M = 0.2
PERIOD_S = 0.05
HOME = (1.5, 1.5)


def building():
    """Two rooms of 7 x 5 m side by side, joined by a door of 1.4 m. Rows of growing y."""
    cells = numpy.zeros((54, 146), dtype=numpy.int8)
    cells[:2, :] = cells[-2:, :] = cells[:, :2] = cells[:, -2:] = 100
    cells[:, 72:74] = 100
    cells[20:34, 72:74] = 0
    return cells


class ToyRobot:
    """`mode` is how goals are met: "drive", "refuse" or "hang"."""

    def __init__(self):
        self.mode = "drive"
        self.goals = []
        self.cancelled = 0
        self._lock = threading.Lock()
        self._truth = building()
        self._maps = rospy.Publisher("/map", OccupancyGrid, queue_size=1, latch=True)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self.reset()
        self._timer = rospy.Timer(rospy.Duration(PERIOD_S), lambda _: self._send_place())
        self._server = actionlib.SimpleActionServer("move_base", MoveBaseAction, self._execute,
                                                    auto_start=False)
        self._server.start()

    def reset(self):
        """At home, and all is unknown but what is seen from there."""
        self.position = HOME
        self._known = numpy.full_like(self._truth, -1)
        self.look()

    def look(self):
        """Sees, through walls too, what is near."""
        rows, columns = numpy.indices(self._truth.shape)
        x, y = (columns + 0.5) * CELL_M, (rows + 0.5) * CELL_M
        near = numpy.hypot(x - self.position[0], y - self.position[1]) < SIGHT_M
        self._known[near] = self._truth[near]
        self._maps.publish(self.map_message())

    def map_message(self):
        message = OccupancyGrid()
        message.header.frame_id = "map"
        message.header.stamp = rospy.Time.now()
        message.info.resolution = CELL_M
        message.info.height, message.info.width = self._known.shape
        message.info.origin.orientation.w = 1.0
        message.data = self._known.ravel().tolist()
        return message

    def publish_map(self, message):
        self._maps.publish(message)

    def share_known(self):
        return numpy.mean(self._known[self._truth == 0] == 0)

    def _send_place(self):
        transform = TransformStamped()
        transform.header.frame_id = "map"
        transform.header.stamp = rospy.Time.now()
        transform.child_frame_id = "base_link"
        transform.transform.translation.x, transform.transform.translation.y = self.position
        transform.transform.rotation.w = 1.0
        if not rospy.is_shutdown():
            self._transforms.publish(TFMessage([transform]))

    def _execute(self, goal):
        target = goal.target_pose.pose.position
        self.goals.append(goal.target_pose)
        while not self._server.is_preempt_requested() and not rospy.is_shutdown():
            rospy.rostime.wallsleep(PERIOD_S)
            if self.mode == "refuse":
                self._server.set_aborted(text="no path: walled in")
                return
            if self.mode == "drive" and self._step((target.x, target.y)):
                self._server.set_succeeded(text="Goal reached.")
                return
        self.cancelled += not self._server.is_new_goal_available()
        self._server.set_preempted()

    def _step(self, target):
        left = math.dist(target, self.position)
        share = min(1.0, STEP_M / left) if left > 0.0 else 1.0
        self.position = tuple(a + share * (b - a) for a, b in zip(self.position, target))
        self.look()
        return share == 1.0
