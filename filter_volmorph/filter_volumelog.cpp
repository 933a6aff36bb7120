#include "filter_volmorph/filter_volumelog.h"

#include <QStringList>

#include "filter_volmorph/handle_measure.h"

namespace meshcomplete {
namespace host {
namespace {

constexpr std::size_t most_handles = 20;  // that are listed one by one

QString number(double value) { return QString::number(value, 'g', 5); }

void add_figure(FilterRun& run, const QString& name, double value) {
  run.report.figures.emplace_back(name.toStdString(), value);
}

QString handle_list(const std::vector<Handle>& handles, const VolumeFrame& frame) {
  QStringList words;
  for (std::size_t i = 0; i < handles.size() && i < most_handles; ++i) {
    const Vector3& at = handles[i].centre;
    const VoxelIndex voxel = frame.voxel(at).array().round().matrix().cast<int>();
    words << QString("%1 (at %2 %3 %4, voxel %5 %6 %7)")
                 .arg(number(handles[i].length), number(at.x()), number(at.y()), number(at.z()))
                 .arg(voxel.x())
                 .arg(voxel.y())
                 .arg(voxel.z());
  }
  if (handles.size() > most_handles)
    words << QString("and %1 more, up to %2")
                 .arg(handles.size() - most_handles)
                 .arg(number(handles.back().length));
  return words.join(", ");
}

}  // namespace

void log_volume(FilterRun& run, const RangeVolume& volume) {
  const VolumeCounts counts = volume.counts();
  const VoxelIndex size = volume.frame().box.size();
  run.log(QString("Volume of %1 x %2 x %3 voxels of %4: %5 seen, %6 unseen, %7 empty, %8 of these filled; %9 MB")
              .arg(size.x())
              .arg(size.y())
              .arg(size.z())
              .arg(number(volume.frame().voxel_size))
              .arg(counts.seen)
              .arg(counts.unseen)
              .arg(counts.empty)
              .arg(counts.filled)
              .arg(number(1e-6 * static_cast<double>(volume.memory()))));
  add_figure(run, "seen voxels", static_cast<double>(counts.seen));
  add_figure(run, "unseen voxels", static_cast<double>(counts.unseen));
  add_figure(run, "empty voxels", static_cast<double>(counts.empty));
  add_figure(run, "filled voxels", static_cast<double>(counts.filled));
  add_figure(run, "volume bytes", static_cast<double>(volume.memory()));
}

void log_topology(FilterRun& run, const RangeVolume& volume, const TriangleMesh& surface, const QString& when,
                  const Progress& progress) {
  const HandleReport report = measure_handles(surface, progress);
  const MeshStatistics& is = report.statistics;
  const QString genus = is.genus ? QString::number(*is.genus) : QString("unknown");
  run.log(QString("%1: %2 vertices, %3 faces, genus %4, %5 components, %6 boundary loops")
              .arg(when)
              .arg(is.vertices)
              .arg(is.faces)
              .arg(genus)
              .arg(is.components)
              .arg(is.boundary_loops.size()));
  if (report.handles && !report.handles->empty())
    run.log(
        QString("%1: loops round the handles: %2").arg(when, handle_list(*report.handles, volume.frame())));
  const QString name = when.toLower();
  add_figure(run, name + " vertices", static_cast<double>(is.vertices));
  add_figure(run, name + " faces", static_cast<double>(is.faces));
  if (is.genus) add_figure(run, name + " genus", static_cast<double>(*is.genus));
  add_figure(run, name + " components", static_cast<double>(is.components));
  add_figure(run, name + " boundary loops", static_cast<double>(is.boundary_loops.size()));
}

void log_origins(FilterRun& run, const SurfaceOrigins& origins, const QString& when) {
  const std::size_t observed = origins.count(SurfaceOrigin::observed);
  const std::size_t filled = origins.count(SurfaceOrigin::filled);
  const std::size_t boundary = origins.count(SurfaceOrigin::boundary);
  run.log(QString("%1: %2 faces observed, %3 filled, %4 between unseen and empty")
              .arg(when)
              .arg(observed)
              .arg(filled)
              .arg(boundary));
  const QString name = when.toLower();
  add_figure(run, name + " observed faces", static_cast<double>(observed));
  add_figure(run, name + " filled faces", static_cast<double>(filled));
  add_figure(run, name + " boundary faces", static_cast<double>(boundary));
}

}  // namespace host
}  // namespace meshcomplete
