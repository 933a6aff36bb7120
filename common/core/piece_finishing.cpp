#include "common/core/piece_finishing.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/core/threads.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

// Rounds in which patches that meet others are taken apart.
constexpr int most_separations = 3;

constexpr const char* meets_another = "the patch meets the patch of another hole";

}  // namespace

// Makes the rough patch, joined to the mesh.
void PieceFinisher::prepare(PatchPiece& piece, const Progress& progress) const {
  RimPatch rough = make_rim_patch(mesh_, topology_, piece.sheet);
  remove_steiner_points(rough, divided_, {}, progress);
  if (rough.steiner_points > 0)
    piece.defect = "the patch could not be joined to " + std::to_string(rough.steiner_points) +
                   (rough.steiner_points == 1 ? " edge of the rim" : " edges of the rim");
  else
    piece.rough.emplace(std::move(rough));
}

void PieceFinisher::finish_one(PatchPiece& piece, const FinishingOptions& options,
                               const std::vector<Corners>& obstacles, const Progress& progress) const {
  if (!piece.rough) return;
  const RimPatch& rough = *piece.rough;
  std::vector<const BoundaryLoop*> rim;
  for (const BoundaryLoop& loop : rough.loops) rim.push_back(&loop);
  const auto find = [&](const PatchMesh& now) {
    PatchFault fault;
    const Patch patch = as_patch(now, rough.rim_vertices, mesh_);
    PatchCheck check = check_patch(input_, patch, rim, progress);
    if (!check.passed()) {
      fault.defect = describe(check.defect);
      if (can_be_mended(check.defect)) fault.triangles = std::move(check.patch_triangles);
    } else if (!obstacles.empty()) {
      std::vector<Corners> triangles;
      for (const Triangle& t : patch.triangles) triangles.push_back(corners(mesh_, patch, t));
      for (const auto& pair : improper_pairs_between(triangles, obstacles))
        fault.triangles.push_back(pair.first);
      fault.triangles.erase(std::unique(fault.triangles.begin(), fault.triangles.end()),
                            fault.triangles.end());
      if (!fault.triangles.empty()) fault.defect = meets_another;
    }
    return fault;
  };
  const FinishedPatch finished =
      meshcomplete::finish(rough.mesh, options, {rough.rim, input_, obstacles, find}, progress);
  piece.route = finished.route;
  piece.defect = finished.defect;
  piece.patch = piece.defect.empty() ? as_patch(finished.mesh, rough.rim_vertices, mesh_) : Patch();
}

void PieceFinisher::finish(std::vector<PatchPiece>& pieces, std::size_t first,
                           const Progress& progress) const {
  double total = 0;
  for (std::size_t i = first; i < pieces.size(); ++i)
    total += pieces[i].wanted ? static_cast<double>(pieces[i].sheet.triangles.size()) : 0;
  const Progress within = progress.part(0, 0, "fairing the patches");
  for_each(pieces.size() - first, 1, progress, [&](std::size_t number) {
    PatchPiece& piece = pieces[first + number];
    if (!piece.wanted) return;
    prepare(piece, within);
    finish_one(piece, options_, obstacles_of(pieces, first + number, first), within);
    progress.advance(static_cast<double>(piece.sheet.triangles.size()) / total);
  });
}

// The patches near a piece, of the first `others` ones.
std::vector<PieceFinisher::Corners> PieceFinisher::obstacles_of(const std::vector<PatchPiece>& pieces,
                                                                std::size_t piece, std::size_t others) const {
  std::vector<Corners> triangles;
  if (others == 0) return triangles;
  Box box;
  for (const SheetVertex& v : pieces[piece].sheet.vertices)
    box.include(bounding_box(v.position, v.position, v.position));
  // A fair surface bulges over the stairs by less than their extent, also where they are flat.
  double size = 0;
  for (int k = 0; k < 3; ++k) size = std::max(size, box.high[k] - box.low[k]);
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= size;
    box.high[k] += size;
  }
  for (std::size_t i = 0; i < others; ++i) {
    if (i == piece) continue;
    for (const Triangle& t : pieces[i].patch.triangles) {
      const Corners c = corners(mesh_, pieces[i].patch, t);
      if (box.meets(bounding_box(c[0], c[1], c[2]))) triangles.push_back(c);
    }
  }
  return triangles;
}

// The pieces whose patches meet another's, ascending; of two that meet only the later one if asked.
std::vector<std::size_t> PieceFinisher::in_conflict(const std::vector<PatchPiece>& pieces,
                                                    bool later_only) const {
  std::vector<Corners> triangles;
  std::vector<std::size_t> owner, found;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (const Triangle& t : pieces[i].patch.triangles) {
      triangles.push_back(corners(mesh_, pieces[i].patch, t));
      owner.push_back(i);
    }
  for (const auto& [a, b] : improper_pairs(triangles)) {
    if (owner[a] == owner[b]) continue;
    found.push_back(std::max(owner[a], owner[b]));
    if (!later_only) found.push_back(std::min(owner[a], owner[b]));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void PieceFinisher::leave_plain(PatchPiece& piece, const Progress& progress) const {
  FinishingOptions plain = options_;
  plain.remesh = false;
  plain.fairing.reset();
  finish_one(piece, plain, {}, progress);
}

bool PieceFinisher::finish_beside(std::vector<PatchPiece>& pieces, std::size_t piece,
                                  const Progress& progress) const {
  finish_one(pieces[piece], options_, obstacles_of(pieces, piece, pieces.size()), progress);
  return pieces[piece].defect.empty();
}

void PieceFinisher::separate(std::vector<PatchPiece>& pieces, const Progress& progress) const {
  for (int round = 0; round < most_separations; ++round) {
    std::vector<std::size_t> plain;
    for (std::size_t i : in_conflict(pieces, true))
      if (!finish_beside(pieces, i, progress)) plain.push_back(i);
    if (plain.empty()) break;
    for (std::size_t i : plain) leave_plain(pieces[i], progress);
    for (std::size_t i : in_conflict(pieces, false))
      if (!std::binary_search(plain.begin(), plain.end(), i) && !finish_beside(pieces, i, progress))
        leave_plain(pieces[i], progress);
    for (std::size_t i : plain)
      if (!finish_beside(pieces, i, progress)) leave_plain(pieces[i], progress);
  }
  for (std::size_t i : in_conflict(pieces, true)) {
    pieces[i].patch = Patch();
    pieces[i].defect = meets_another;
  }
  progress.update(1);
}

}  // namespace meshcomplete
