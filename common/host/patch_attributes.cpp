#include "common/host/patch_attributes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <unordered_map>

#include "common/core/attributes.h"

namespace meshcomplete {
namespace host {
namespace {

/// Which attributes the layer has, and in which columns of the interpolation they stand.
struct Columns {
  static constexpr Eigen::Index absent = -1;
  static constexpr Eigen::Index vertex_color = 0;
  static constexpr Eigen::Index vertex_quality = 4;
  Eigen::Index vertex_radius = absent;
  Eigen::Index vertex_texcoord = absent;
  Eigen::Index face_color = absent;
  Eigen::Index face_quality = absent;
  Eigen::Index wedge_texcoord = absent;
  Eigen::Index count = 5;

  explicit Columns(const CMeshO& mesh) {
    const auto take = [this](bool present, Eigen::Index& column, Eigen::Index width) {
      if (!present) return;
      column = count;
      count += width;
    };
    take(mesh.vert.IsRadiusEnabled(), vertex_radius, 1);
    take(mesh.vert.IsTexCoordEnabled(), vertex_texcoord, 2);
    take(mesh.face.IsColorEnabled(), face_color, 4);
    take(mesh.face.IsQualityEnabled(), face_quality, 1);
    take(mesh.face.IsWedgeTexCoordEnabled(), wedge_texcoord, 2);
  }
  bool face_values() const {
    return face_color != absent || face_quality != absent || wedge_texcoord != absent;
  }
};

/// An edge of the patch that lies on the rim, and the face of the layer on its other side.
struct RimEdge {
  std::size_t half_edge;  ///< 3 * patch triangle + corner where it starts
  const CFaceO* face;
  int corner;  ///< of `face` where its half-edge, which runs the other way, starts
};

double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

void put(Eigen::Ref<Eigen::RowVectorXd> row, Eigen::Index column, const vcg::Color4b& color) {
  for (int channel = 0; channel < 4; ++channel) row[column + channel] += color[channel];
}

vcg::Color4b color_at(const Eigen::RowVectorXd& row, Eigen::Index column) {
  vcg::Color4b color;
  for (int channel = 0; channel < 4; ++channel)
    color[channel] = static_cast<unsigned char>(std::lround(std::clamp(row[column + channel], 0.0, 255.0)));
  return color;
}

vcg::TexCoord2f texcoord_at(const Eigen::RowVectorXd& row, Eigen::Index column, short texture) {
  vcg::TexCoord2f texcoord(static_cast<float>(row[column]), static_cast<float>(row[column + 1]));
  texcoord.N() = texture;
  return texcoord;
}

/// Interpolates the attributes of one patch. Patch vertices are numbered locally: first the rim's, then the
/// new ones.
class Interpolation {
 public:
  Interpolation(const MeshModel& model, const TriangleMesh& mesh, const Patch& patch,
                const std::vector<Index>& left_out)
      : layer_(model.cm), mesh_(mesh), patch_(patch), left_out_(left_out), columns_(model.cm) {
    number_vertices();
    find_components();
    if (columns_.face_values()) find_rim_edges();
    if (columns_.vertex_texcoord != Columns::absent) choose_vertex_textures();
    if (columns_.wedge_texcoord != Columns::absent) choose_wedge_textures();
    gather_rim();
    const Eigen::MatrixXd inside = interpolate_attributes(
        mesh_, patch_, columns_.count, [this](Index v) { return Eigen::RowVectorXd(rows_.row(local(v))); });
    rows_.bottomRows(inside.rows()) = inside;
  }

  PatchAttributes attributes() const;

 private:
  void number_vertices();
  void find_components();
  void find_rim_edges();
  void choose_vertex_textures();
  void choose_wedge_textures();
  void gather_rim();
  void gather_rim_faces();
  void add_wedge(const RimEdge& edge, int corner, std::vector<double>& weights);
  void set_vertex_attributes(PatchAttributes& result) const;
  void set_face_attributes(PatchAttributes& result) const;
  void set_wedges(PatchAttributes& result) const;

  Eigen::Index local(Index vertex) const {
    if (vertex < patch_.input_vertices) return rim_number_.at(vertex);
    return static_cast<Eigen::Index>(rim_.size() + (vertex - patch_.input_vertices));
  }
  std::size_t component(Index vertex) const { return component_[static_cast<std::size_t>(local(vertex))]; }
  Index start(std::size_t half_edge) const { return patch_.triangles[half_edge / 3][half_edge % 3]; }
  Index end(std::size_t half_edge) const { return patch_.triangles[half_edge / 3][(half_edge + 1) % 3]; }
  const Vector3& position(Index v) const { return meshcomplete::position(mesh_, patch_, v); }

  const CMeshO& layer_;
  const TriangleMesh& mesh_;
  const Patch& patch_;
  const std::vector<Index>& left_out_;
  Columns columns_;
  std::vector<Index> rim_;
  std::unordered_map<Index, Eigen::Index> rim_number_;
  std::vector<std::size_t>
      component_;  // per local vertex: a local vertex that stands for its connected piece
  std::vector<RimEdge> rim_edges_;
  std::map<std::size_t, short> vertex_texture_;  // per component
  std::map<std::size_t, short> wedge_texture_;   // per component
  Eigen::MatrixXd rows_;                         // per local vertex
};

void Interpolation::number_vertices() {
  for (const Triangle& triangle : patch_.triangles)
    for (const Index v : triangle)
      if (v < patch_.input_vertices && rim_number_.emplace(v, rim_.size()).second) rim_.push_back(v);
}

void Interpolation::find_components() {
  component_.resize(rim_.size() + patch_.vertices.size());
  std::iota(component_.begin(), component_.end(), std::size_t{0});
  const auto root = [this](std::size_t v) {
    while (component_[v] != v) v = component_[v] = component_[component_[v]];
    return v;
  };
  for (const Triangle& triangle : patch_.triangles)
    for (int corner = 1; corner < 3; ++corner)
      component_[root(static_cast<std::size_t>(local(triangle[corner])))] =
          root(static_cast<std::size_t>(local(triangle[0])));
  for (std::size_t v = 0; v < component_.size(); ++v) component_[v] = root(v);
}

void Interpolation::find_rim_edges() {
  const auto key = [](Index from, Index to) { return (static_cast<std::uint64_t>(from) << 32) | to; };
  std::unordered_map<std::uint64_t, std::size_t> half_edges;
  for (std::size_t h = 0; h < 3 * patch_.triangles.size(); ++h)
    if (start(h) < patch_.input_vertices && end(h) < patch_.input_vertices)
      half_edges.emplace(key(start(h), end(h)), h);
  std::vector<char> on_rim(layer_.vert.size(), 0);
  for (const Index v : rim_) on_rim[v] = 1;
  const CVertexO* const first = layer_.vert.data();
  for (const CFaceO& face : layer_.face) {
    const auto place = static_cast<Index>(&face - layer_.face.data());
    if (face.IsD() || std::binary_search(left_out_.begin(), left_out_.end(), place)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const auto from = static_cast<Index>(face.cV(corner) - first);
      const auto to = static_cast<Index>(face.cV((corner + 1) % 3) - first);
      if (!on_rim[from] || !on_rim[to]) continue;
      const auto found = half_edges.find(key(to, from));
      if (found != half_edges.end()) rim_edges_.push_back({found->second, &face, corner});
    }
  }
}

/// The most frequent texture of each component.
std::map<std::size_t, short> winners(const std::map<std::size_t, std::map<short, int>>& votes) {
  std::map<std::size_t, short> result;
  for (const auto& [component, counts] : votes)
    result[component] = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                          return a.second < b.second;
                        })->first;
  return result;
}

void Interpolation::choose_vertex_textures() {
  std::map<std::size_t, std::map<short, int>> votes;
  for (const Index v : rim_) ++votes[component(v)][layer_.vert[v].cT().N()];
  vertex_texture_ = winners(votes);
}

void Interpolation::choose_wedge_textures() {
  std::map<std::size_t, std::map<short, int>> votes;
  for (const RimEdge& edge : rim_edges_)
    ++votes[component(start(edge.half_edge))][edge.face->cWT(edge.corner).N()];
  wedge_texture_ = winners(votes);
}

void Interpolation::gather_rim() {
  rows_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(component_.size()), columns_.count);
  for (const Index v : rim_) {
    const CVertexO& vertex = layer_.vert[v];
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(columns_.count);
    put(row, Columns::vertex_color, vertex.cC());
    row[Columns::vertex_quality] = finite_or_zero(vertex.cQ());
    if (columns_.vertex_radius != Columns::absent) row[columns_.vertex_radius] = finite_or_zero(vertex.cR());
    if (columns_.vertex_texcoord != Columns::absent) {
      row[columns_.vertex_texcoord] = finite_or_zero(vertex.cT().U());
      row[columns_.vertex_texcoord + 1] = finite_or_zero(vertex.cT().V());
    }
    rows_.row(local(v)) = row;
  }
  gather_rim_faces();
}

void Interpolation::gather_rim_faces() {
  std::vector<double> faces(rim_.size(), 0.0);
  std::vector<double> wedges(rim_.size(), 0.0);
  for (const RimEdge& edge : rim_edges_) {
    for (const int corner : {edge.corner, (edge.corner + 1) % 3}) {
      const Eigen::Index v = local(static_cast<Index>(edge.face->cV(corner) - layer_.vert.data()));
      faces[static_cast<std::size_t>(v)] += 1;
      Eigen::RowVectorXd row = rows_.row(v);
      if (columns_.face_color != Columns::absent) put(row, columns_.face_color, edge.face->cC());
      if (columns_.face_quality != Columns::absent)
        row[columns_.face_quality] += finite_or_zero(edge.face->cQ());
      rows_.row(v) = row;
      if (columns_.wedge_texcoord != Columns::absent) add_wedge(edge, corner, wedges);
    }
  }
  for (std::size_t v = 0; v < rim_.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(v);
    const double mean = faces[v] > 0 ? 1 / faces[v] : 0.0;
    if (columns_.face_color != Columns::absent) rows_.row(row).segment(columns_.face_color, 4) *= mean;
    if (columns_.face_quality != Columns::absent) rows_(row, columns_.face_quality) *= mean;
    if (columns_.wedge_texcoord != Columns::absent && wedges[v] > 0)
      rows_.row(row).segment(columns_.wedge_texcoord, 2) /= wedges[v];
  }
}

/// Adds one wedge to the mean at its vertex. Wedges of another texture than the piece's count so little that
/// they only matter where there are no others.
void Interpolation::add_wedge(const RimEdge& edge, int corner, std::vector<double>& weights) {
  constexpr double other_texture = 1e-12;
  const auto vertex = static_cast<Index>(edge.face->cV(corner) - layer_.vert.data());
  const Eigen::Index v = local(vertex);
  const vcg::TexCoord2f& wedge = edge.face->cWT(corner);
  const double weight = wedge.N() == wedge_texture_.at(component(vertex)) ? 1.0 : other_texture;
  rows_(v, columns_.wedge_texcoord) += weight * finite_or_zero(wedge.U());
  rows_(v, columns_.wedge_texcoord + 1) += weight * finite_or_zero(wedge.V());
  weights[static_cast<std::size_t>(v)] += weight;
}

void Interpolation::set_vertex_attributes(PatchAttributes& result) const {
  for (std::size_t i = 0; i < patch_.vertices.size(); ++i) {
    const std::size_t v = rim_.size() + i;
    const Eigen::RowVectorXd row = rows_.row(static_cast<Eigen::Index>(v));
    result.vertex_colors.push_back(color_at(row, Columns::vertex_color));
    result.vertex_qualities.push_back(static_cast<float>(row[Columns::vertex_quality]));
    if (columns_.vertex_radius != Columns::absent)
      result.vertex_radii.push_back(static_cast<float>(row[columns_.vertex_radius]));
    if (columns_.vertex_texcoord != Columns::absent)
      result.vertex_texcoords.push_back(
          texcoord_at(row, columns_.vertex_texcoord, vertex_texture_.at(component_[v])));
  }
}

void Interpolation::set_face_attributes(PatchAttributes& result) const {
  for (const Triangle& triangle : patch_.triangles) {
    const Vector3 a = position(triangle[0]);
    result.face_normals.push_back((position(triangle[1]) - a).cross(position(triangle[2]) - a).normalized());
    const Eigen::RowVectorXd mean =
        (rows_.row(local(triangle[0])) + rows_.row(local(triangle[1])) + rows_.row(local(triangle[2]))) / 3;
    if (columns_.face_color != Columns::absent)
      result.face_colors.push_back(color_at(mean, columns_.face_color));
    if (columns_.face_quality != Columns::absent)
      result.face_qualities.push_back(static_cast<float>(mean[columns_.face_quality]));
  }
}

void Interpolation::set_wedges(PatchAttributes& result) const {
  for (const Triangle& triangle : patch_.triangles) {
    const auto known = wedge_texture_.find(component(triangle[0]));
    const short texture = known == wedge_texture_.end() ? short(0) : known->second;
    std::array<vcg::TexCoord2f, 3> wedges;
    for (std::size_t corner = 0; corner < 3; ++corner)
      wedges[corner] = texcoord_at(rows_.row(local(triangle[corner])), columns_.wedge_texcoord, texture);
    result.wedge_texcoords.push_back(wedges);
  }
  for (const RimEdge& edge : rim_edges_) {
    std::array<vcg::TexCoord2f, 3>& wedges = result.wedge_texcoords[edge.half_edge / 3];
    const vcg::TexCoord2f& at_end = edge.face->cWT(edge.corner);
    const vcg::TexCoord2f& at_start = edge.face->cWT((edge.corner + 1) % 3);
    if (at_end.N() != wedges[0].N() || at_start.N() != wedges[0].N()) continue;
    wedges[edge.half_edge % 3] = at_start;
    wedges[(edge.half_edge + 1) % 3] = at_end;
  }
}

PatchAttributes Interpolation::attributes() const {
  PatchAttributes result;
  result.vertex_normals = patch_vertex_normals(mesh_, patch_);
  set_vertex_attributes(result);
  set_face_attributes(result);
  if (columns_.wedge_texcoord != Columns::absent) set_wedges(result);
  return result;
}

}  // namespace

PatchAttributes patch_attributes(const MeshModel& model, const TriangleMesh& mesh, const Patch& patch,
                                 const std::vector<Index>& left_out) {
  if (patch.empty()) return {};
  return Interpolation(model, mesh, patch, left_out).attributes();
}

}  // namespace host
}  // namespace meshcomplete
