#include "viewpoint_markers.h"

#include <algorithm>
#include <utility>

#include "hv_ros/conversions.h"
#include "hv_ros/markers.h"
#include "pose_message.h"

namespace hv::explore {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kText_m = 0.35;
constexpr int kBright = 60;  ///< utility from which the colour no longer changes

std_msgs::ColorRGBA ColorOf(int utility, bool visited) {
  if (visited) return Color(0.3F, 0.5F, 1.0F);
  if (utility == 0) return Color(0.5F, 0.5F, 0.5F, 0.6F);
  const float share = static_cast<float>(std::min(utility, kBright)) / kBright;
  return Color(1.0F - share, 0.5F + 0.5F * share, 0.1F);
}

/// Builds the markers of one decision.
class MarkerBuilder {
 public:
  MarkerBuilder(const GoalChooser& chooser, double height_m)
      : chooser_(chooser), graph_(chooser.model()->graph()), height_m_(height_m) {}

  Marker Viewpoints() const {
    Marker marker = MakeMarker("viewpoints", Marker::SPHERE_LIST, 0.15, Color(1, 1, 1));
    for (int viewpoint = 0; viewpoint < graph_.size(); ++viewpoint) {
      marker.points.push_back(At(viewpoint));
      marker.colors.push_back(
          ColorOf(chooser_.model()->UtilityOf(viewpoint), graph_.Visited(viewpoint)));
    }
    return marker;
  }

  Marker Edges() const {
    Marker marker = MakeMarker("edges", Marker::LINE_LIST, 0.02, Color(0.6F, 0.7F, 0.9F, 0.25F));
    for (int viewpoint = 0; viewpoint < graph_.size(); ++viewpoint) {
      for (const ViewpointGraph::Edge& edge : graph_.EdgesOf(viewpoint)) {
        if (edge.to < viewpoint) continue;
        marker.points.push_back(At(viewpoint));
        marker.points.push_back(At(edge.to));
      }
    }
    return marker;
  }

  /// Of the viewpoints that the robot can reach.
  std::vector<Marker> Utilities() const {
    std::vector<Marker> texts;
    for (const Observation::Node& node : chooser_.observation().nodes) {
      if (node.utility == 0) continue;
      Marker text = MakeMarker("utilities", Marker::TEXT_VIEW_FACING, kText_m, Color(1, 1, 1));
      text.id = static_cast<int>(texts.size());
      text.pose.position = At(node.viewpoint);
      text.pose.position.z += kText_m;
      text.text = std::to_string(node.utility);
      texts.push_back(std::move(text));
    }
    return texts;
  }

  Marker Way(const ViewpointGoal& goal) const {
    Marker marker = MakeMarker("way", Marker::LINE_STRIP, 0.08, Color(1.0F, 0.85F, 0.1F));
    for (const Eigen::Vector2d& position : chooser_.WayTo(goal)) {
      marker.points.push_back(Raised(position));
    }
    return marker;
  }

  Marker Goal(const ViewpointGoal& goal, const std::string& frame) const {
    Marker marker = MakeMarker("goal", Marker::ARROW, 0.2, Color(1.0F, 0.3F, 0.2F));
    marker.scale.x = 0.8;
    marker.pose = ToPoseStamped(goal.pose, frame).pose;
    marker.pose.position.z = height_m_;
    return marker;
  }

 private:
  geometry_msgs::Point Raised(const Eigen::Vector2d& position) const {
    return ToPointMessage({position.x(), position.y(), height_m_});
  }
  geometry_msgs::Point At(int viewpoint) const {
    return Raised(chooser_.frame().CenterOf(graph_.CellOf(viewpoint)));
  }

  const GoalChooser& chooser_;
  const ViewpointGraph& graph_;
  double height_m_;
};

}  // namespace

MarkerArray ToViewpointMarkers(const GoalChooser& chooser, const std::optional<ViewpointGoal>& goal,
                               const std::string& frame, double height_m) {
  MarkerArray array;
  array.markers.emplace_back().action = Marker::DELETEALL;
  if (chooser.model() != nullptr) {
    const MarkerBuilder builder(chooser, height_m);
    array.markers.push_back(builder.Viewpoints());
    array.markers.push_back(builder.Edges());
    for (Marker& text : builder.Utilities()) array.markers.push_back(std::move(text));
    if (goal) {
      array.markers.push_back(builder.Way(*goal));
      array.markers.push_back(builder.Goal(*goal, frame));
    }
  }
  for (Marker& marker : array.markers) {
    marker.header.frame_id = frame;
    marker.header.stamp = ros::Time::now();
  }
  return array;
}

std::vector<Point> FrontierCloud(const GoalChooser& chooser, double height_m) {
  std::vector<Point> cloud;
  if (chooser.model() == nullptr) return cloud;
  const Frontiers& frontiers = chooser.model()->frontiers();
  const Eigen::Vector2i half = Eigen::Vector2i::Constant((frontiers.block() - 1) / 2);
  for (const int frontier : frontiers.points()) {
    const Eigen::Vector2d at = chooser.frame().CenterOf(frontiers.CellOf(frontier) + half);
    Point point;
    point.x = static_cast<float>(at.x());
    point.y = static_cast<float>(at.y());
    point.z = static_cast<float>(height_m);
    cloud.push_back(point);
  }
  return cloud;
}

}  // namespace hv::explore
