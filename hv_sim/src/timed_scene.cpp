#include "timed_scene.h"

#include <utility>

#include "hv_sim/mesh_builder.h"

namespace hv::sim {
namespace {

void Append(const Mesh& part, Mesh& mesh) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({a + offset, b + offset, c + offset});
  }
  mesh.reflectivity.insert(mesh.reflectivity.end(), part.reflectivity.begin(),
                           part.reflectivity.end());
}

}  // namespace

TimedScene::TimedScene(Mesh mesh)
    : mesh_(std::move(mesh)), scene_(std::make_shared<RayCaster>(mesh_)) {}

void TimedScene::Add(const TimedBox& box) {
  boxes_.push_back(box);
  present_.push_back(false);
}

std::vector<bool> TimedScene::PresentAt(double time_s) const {
  std::vector<bool> present;
  for (const TimedBox& box : boxes_) {
    present.push_back(box.from_s <= time_s && time_s < box.until_s);
  }
  return present;
}

bool TimedScene::Update(double time_s) {
  std::vector<bool> present = PresentAt(time_s);
  if (present == present_) return false;
  present_ = std::move(present);
  MeshBuilder builder;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (present_[i]) builder.AddBox(Upright(boxes_[i].center), boxes_[i].size);
  }
  Mesh mesh = mesh_;
  Append(builder.mesh(), mesh);
  scene_ = std::make_shared<RayCaster>(mesh);
  return true;
}

}  // namespace hv::sim
