// Compares a mesh with holes with what a program made of it, whichever program that was.
//
//   measure_completion prepare IN OUT.ply             the mesh as binary PLY with triangles; prints what it
//   is like measure_completion measure INPUT.ply OUTPUT       prints what became of the holes and how good
//   the new faces are measure_completion picture INPUT.ply OUTPUT P.ply writes the mesh to look at: new faces
//   in orange, those that
//                                                     intersect something in red
//
// Everything is printed as one JSON object. Vertices and faces are recognised by their positions, bit for
// bit: nothing is taken from what the program says about itself.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmarks/mesh_file.h"
#include "common/core/boundary_loops.h"
#include "common/core/mesh_statistics.h"
#include "common/core/mesh_topology.h"
#include "common/core/triangle_intersection.h"

namespace {

using meshcomplete::BoundaryLoop;
using meshcomplete::Index;
using meshcomplete::LoopDefect;
using meshcomplete::MeshTopology;
using meshcomplete::Triangle;
using meshcomplete::TriangleMesh;
using meshcomplete::Vector3;
using meshcomplete::benchmarks::Colour;
using Corners = std::array<Vector3, 3>;

constexpr double degrees = 180 / 3.14159265358979323846;

/// Collects the numbers that are printed, in order.
class Record {
 public:
  void add(const char* key, std::size_t value) { add_text(key, std::to_string(value)); }
  void add(const char* key, bool value) { add_text(key, value ? "true" : "false"); }
  void add(const char* key, double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    add_text(key, std::isfinite(value) ? text : "null");
  }
  void add_text(const char* key, const std::string& value) {
    text_ += (text_.empty() ? "{\"" : ", \"") + std::string(key) + "\": " + value;
  }
  void print() const { std::printf("%s}\n", text_.c_str()); }

 private:
  std::string text_;
};

/// Numbers positions: vertices at the same place, bit for bit, get the same number (-0 and 0 are the same
/// place).
class Places {
 public:
  std::vector<Index> number(const TriangleMesh& mesh) {
    std::vector<Index> numbers;
    numbers.reserve(mesh.vertices.size());
    for (const Vector3& p : mesh.vertices) {
      const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
      numbers.push_back(places_.try_emplace(key, static_cast<Index>(places_.size())).first->second);
    }
    return numbers;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::size_t hash = 0;
      for (double c : p) hash = (hash ^ std::hash<double>()(c)) * 0x9e3779b97f4a7c15u;
      return hash ^ (hash >> 29);
    }
  };
  std::unordered_map<std::array<double, 3>, Index, Hash> places_;
};

/// The corners of a face as places, the smallest first, in the face's direction.
Triangle face_key(const std::vector<Index>& places, const Triangle& t) {
  Triangle key = {places[t[0]], places[t[1]], places[t[2]]};
  std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
  return key;
}

std::pair<Index, Index> edge_key(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// The outer rim of a sheet is a boundary, and yet no hole.
bool is_sheet(const BoundaryLoop& loop) {
  return loop.defect == LoopDefect::open_sheet || loop.defect == LoopDefect::isolated_triangle;
}

Vector3 normal(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * degrees;
}

double smallest_angle(const Corners& c) {
  double least = 180;
  for (int k = 0; k < 3; ++k)
    least = std::min(least, angle_between(c[(k + 1) % 3] - c[k], c[(k + 2) % 3] - c[k]));
  return meshcomplete::collinear(c[0], c[1], c[2]) ? 0 : least;
}

/// Mean and maximum of a list of numbers as it comes in.
struct Mean {
  double sum = 0, greatest = 0;
  std::size_t count = 0;
  void include(double value) {
    sum += value;
    greatest = std::max(greatest, value);
    ++count;
  }
  double value() const { return count == 0 ? std::nan("") : sum / static_cast<double>(count); }
};

class Comparison {
 public:
  Comparison(TriangleMesh input, TriangleMesh output)
      : input_(std::move(input)), output_(std::move(output)), topology_(build_topology(output_)) {
    input_places_ = places_.number(input_);
    output_places_ = places_.number(output_);
    corners_.reserve(output_.triangles.size());
    for (const Triangle& t : output_.triangles)
      corners_.push_back({output_.vertices[t[0]], output_.vertices[t[1]], output_.vertices[t[2]]});
    find_new_faces();
    find_intersections();
  }

  void measure(Record& record) const {
    add_preservation(record);
    add_holes(record);
    add_shape(record);
    const meshcomplete::MeshStatistics whole = meshcomplete::measure(output_, false);
    record.add("boundary_edges", whole.boundary_edges);
    record.add("non_manifold_edges", whole.non_manifold_edges);
    record.add("components", whole.components);
    record.add_text("genus", whole.genus ? std::to_string(*whole.genus) : "null");
    record.add("watertight", whole.watertight());
  }

  void write_picture(const char* path) const {
    TriangleMesh picture;
    std::vector<Colour> colours;
    for (std::size_t f = 0; f < corners_.size(); ++f) {
      const Index first = static_cast<Index>(picture.vertices.size());
      picture.triangles.push_back({first, first + 1, first + 2});
      for (const Vector3& corner : corners_[f]) {
        picture.vertices.push_back(corner);
        colours.push_back(!new_[f]  ? Colour{235, 236, 240}
                          : bad_[f] ? Colour{240, 30, 30}
                                    : Colour{255, 180, 60});
      }
    }
    meshcomplete::benchmarks::write_ply(path, picture, colours);
  }

 private:
  void find_new_faces() {
    std::map<Triangle, std::size_t> old;
    for (const Triangle& t : input_.triangles) ++old[face_key(input_places_, t)];
    missing_faces_ = input_.triangles.size();
    new_.assign(output_.triangles.size(), true);
    for (std::size_t f = 0; f < output_.triangles.size(); ++f) {
      const auto match = old.find(face_key(output_places_, output_.triangles[f]));
      if (match == old.end() || match->second == 0) continue;
      --match->second;
      --missing_faces_;
      new_[f] = false;
    }
  }

  void find_intersections() {
    std::vector<Corners> added, kept;
    std::vector<std::size_t> faces;
    for (std::size_t f = 0; f < corners_.size(); ++f) {
      (new_[f] ? added : kept).push_back(corners_[f]);
      if (new_[f]) faces.push_back(f);
    }
    bad_.assign(corners_.size(), false);
    for (const auto& [a, b] : meshcomplete::improper_pairs(added)) {
      bad_[faces[a]] = bad_[faces[b]] = true;
      ++pairs_;
    }
    for (const auto& pair : meshcomplete::improper_pairs_between(added, kept)) {
      bad_[faces[pair.first]] = true;
      ++pairs_;
    }
  }

  void add_preservation(Record& record) const {
    std::vector<char> present(input_places_.size() + output_places_.size(), false), asked(present);
    for (Index place : output_places_) present[place] = true;
    std::size_t missing = 0;
    for (const Triangle& t : input_.triangles)
      for (Index corner : t) {
        const Index place = input_places_[corner];
        missing += !present[place] && !asked[place];
        asked[place] = true;
      }
    record.add("input_kept", missing == 0 && missing_faces_ == 0);
    record.add("vertices_lost", missing);
    record.add("faces_lost", missing_faces_);
  }

  /// Every piece of patch is known by one of its faces.
  std::vector<std::size_t> pieces() const {
    std::vector<std::size_t> root(corners_.size());
    for (std::size_t f = 0; f < root.size(); ++f) root[f] = f;
    const auto find = [&](std::size_t f) {
      while (root[f] != f) f = root[f] = root[root[f]];
      return f;
    };
    for (Index h = 0; h < topology_.opposite.size(); ++h) {
      const Index other = topology_.opposite[h];
      if (other < topology_.opposite.size() && new_[h / 3] && new_[other / 3])
        root[find(h / 3)] = find(other / 3);
    }
    for (std::size_t f = 0; f < root.size(); ++f) root[f] = find(f);
    return root;
  }

  /// What the faces at one edge of the output are like.
  struct EdgeState {
    bool open = false, clean = true;
    void include(bool is_open, bool is_clean) {
      open |= is_open;
      clean &= is_clean;
    }
  };
  using EdgeStates = std::map<std::pair<Index, Index>, EdgeState>;

  bool kept_its_number(Index v) const {
    return v < input_places_.size() && input_places_[v] == output_places_[v];
  }

  void add_holes(Record& record) const {
    const std::vector<std::size_t> piece = pieces();
    std::vector<char> bad_piece(piece.size(), false);
    for (std::size_t f = 0; f < piece.size(); ++f)
      if (new_[f] && (bad_[f] || smallest_angle(corners_[f]) == 0)) bad_piece[piece[f]] = true;
    // Two parts of a mesh may have edges at one place: vertices that kept their numbers tell them apart.
    EdgeStates by_number, by_place;
    for (Index h = 0; h < topology_.opposite.size(); ++h) {
      const Index a = output_.triangles[h / 3][h % 3], b = output_.triangles[h / 3][(h + 1) % 3];
      const bool open = topology_.opposite[h] >= topology_.opposite.size();
      const bool clean = !(new_[h / 3] && bad_piece[piece[h / 3]]);
      by_place[edge_key(output_places_[a], output_places_[b])].include(open, clean);
      if (kept_its_number(a) && kept_its_number(b)) by_number[edge_key(a, b)].include(open, clean);
    }
    const auto state = [&](Index a, Index b) {
      const auto numbered = by_number.find(edge_key(a, b));
      if (numbered != by_number.end() && !numbered->second.open) return numbered->second;
      const auto placed = by_place.find(edge_key(input_places_[a], input_places_[b]));
      return placed != by_place.end() ? placed->second : EdgeState{true, false};
    };
    std::size_t holes = 0, closed = 0, clean = 0, sheets = 0, sheets_closed = 0;
    for (const BoundaryLoop& loop : trace_boundary_loops(input_, build_topology(input_))) {
      bool is_closed = true, is_clean = true;
      for (std::size_t i = 0; i < loop.faces.size(); ++i) {
        const Index next = loop.vertices[(i + 1) % loop.vertices.size()];
        const Triangle& face = input_.triangles[loop.faces[i]];
        if (std::count(face.begin(), face.end(), next) == 0) continue;  // behind the end of an open chain
        const EdgeState edge = state(loop.vertices[i], next);
        is_closed &= !edge.open;
        is_clean &= edge.clean;
      }
      (is_sheet(loop) ? sheets : holes) += 1;
      (is_sheet(loop) ? sheets_closed : closed) += is_closed;
      clean += !is_sheet(loop) && is_closed && is_clean;
    }
    record.add("holes", holes);
    record.add("holes_closed", closed);
    record.add("holes_closed_without_intersection", clean);
    record.add("sheets", sheets);
    record.add("sheets_covered", sheets_closed);
    record.add("new_intersecting_pairs", pairs_);
  }

  void add_shape(Record& record) const {
    std::vector<char> at_seam(output_.vertices.size(), false);
    std::size_t added = 0;
    Mean jump, ring_jump, ring_edge, inner_edge, edge_at_seam, smallest;
    double worst = 180;
    const auto for_each_edge = [&](const auto& visit) {
      for (Index h = 0; h < topology_.opposite.size(); ++h) {
        const Index other = topology_.opposite[h];
        if (other < topology_.opposite.size() && h < other)
          visit(h / 3, other / 3, output_.triangles[h / 3][h % 3], output_.triangles[h / 3][(h + 1) % 3]);
      }
    };
    for_each_edge([&](Index f, Index g, Index a, Index b) {
      if (new_[f] == new_[g]) return;
      at_seam[a] = at_seam[b] = true;
      jump.include(angle_between(normal(corners_[f]), normal(corners_[g])));
    });
    const auto in_ring = [&](Index f) {
      const Triangle& t = output_.triangles[f];
      return at_seam[t[0]] || at_seam[t[1]] || at_seam[t[2]];
    };
    for_each_edge([&](Index f, Index g, Index a, Index b) {
      const double length = (output_.vertices[a] - output_.vertices[b]).norm();
      if (new_[f] && new_[g]) {
        inner_edge.include(length);
        if (at_seam[a] || at_seam[b]) edge_at_seam.include(length);
      } else if (!new_[f] && !new_[g]) {
        if (in_ring(f) || in_ring(g)) ring_edge.include(length);
        if (in_ring(f) && in_ring(g))
          ring_jump.include(angle_between(normal(corners_[f]), normal(corners_[g])));
      } else {
        ring_edge.include(length);
      }
    });
    for (std::size_t f = 0; f < corners_.size(); ++f) {
      if (!new_[f]) continue;
      ++added;
      smallest.include(smallest_angle(corners_[f]));
      worst = std::min(worst, smallest_angle(corners_[f]));
    }
    record.add("faces_added", added);
    record.add("worst_angle", added == 0 ? std::nan("") : worst);
    record.add("mean_smallest_angle", smallest.value());
    record.add("longest_edge_ratio",
               inner_edge.count == 0 ? std::nan("") : inner_edge.greatest / ring_edge.value());
    record.add("edge_ratio", inner_edge.value() / ring_edge.value());
    record.add("edge_ratio_at_seam", edge_at_seam.value() / ring_edge.value());
    record.add("normal_jump_at_seam", jump.value());
    record.add("normal_jump_beside_seam", ring_jump.value());
  }

  TriangleMesh input_, output_;
  MeshTopology topology_;  // of the output
  Places places_;
  std::vector<Index> input_places_, output_places_;
  std::vector<Corners> corners_;  // of the output
  std::vector<char> new_;         // per face of the output: no face of the input
  std::vector<char> bad_;         // per face of the output: new, and meets another improperly
  std::size_t missing_faces_ = 0;
  std::size_t pairs_ = 0;
};

void prepare(const char* from, const char* to) {
  const TriangleMesh mesh = meshcomplete::benchmarks::read_mesh(from);
  meshcomplete::benchmarks::write_ply(to, mesh);
  const MeshTopology topology = build_topology(mesh);
  std::size_t holes = 0, sheets = 0, longest = 0;
  for (const BoundaryLoop& loop : trace_boundary_loops(mesh, topology)) {
    (is_sheet(loop) ? sheets : holes) += 1;
    if (!is_sheet(loop)) longest = std::max(longest, loop.faces.size());
  }
  Record record;
  record.add("vertices", mesh.vertices.size());
  record.add("faces", mesh.triangles.size());
  record.add("boundary_edges", topology.boundary_half_edges.size());
  record.add("non_manifold_edges", !topology.non_manifold_half_edges.empty());
  record.add("holes", holes);
  record.add("sheets", sheets);
  record.add("longest_hole", longest);
  record.print();
}

int run(int argc, char** argv) {
  const std::string task = argc > 1 ? argv[1] : "";
  if (task == "prepare" && argc == 4) {
    prepare(argv[2], argv[3]);
  } else if (task == "measure" && argc == 4) {
    Record record;
    Comparison(meshcomplete::benchmarks::read_mesh(argv[2]), meshcomplete::benchmarks::read_mesh(argv[3]))
        .measure(record);
    record.print();
  } else if (task == "picture" && argc == 5) {
    Comparison(meshcomplete::benchmarks::read_mesh(argv[2]), meshcomplete::benchmarks::read_mesh(argv[3]))
        .write_picture(argv[4]);
  } else {
    std::fprintf(
        stderr,
        "usage: measure_completion prepare IN OUT.ply | measure INPUT.ply OUTPUT | picture INPUT.ply OUTPUT "
        "PICTURE.ply\n");
    return 2;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
