// Reading and writing meshes through MeshLab's format plugins.
#include <common/filter_parameter/rich_parameter_list.h>
#include <vcg/complex/algorithms/clean.h>
#include <vcg/complex/algorithms/update/bounding.h>
#include <vcg/complex/algorithms/update/normal.h>
#include <wrap/io_trimesh/io_mask.h>

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <cmath>

#include "common/core/error.h"
#include "common/host/runner_host.h"
#include "common/host/runner_state.h"
#include "common/host/runner_text.h"

namespace meshcomplete {
namespace host {

namespace {

using vcg::tri::io::Mask;

struct AttributeCode {
  const char* code;
  int file_bits;
  int mesh_bits;  ///< 0 where MeshLab's data mask has no such bit
};

const std::vector<AttributeCode>& codes() {
  static const std::vector<AttributeCode> table = {
      {"vc", Mask::IOM_VERTCOLOR, MeshModel::MM_VERTCOLOR},
      {"vf", Mask::IOM_VERTFLAGS, 0},
      {"vq", Mask::IOM_VERTQUALITY, MeshModel::MM_VERTQUALITY},
      {"vn", Mask::IOM_VERTNORMAL, 0},
      {"vt", Mask::IOM_VERTTEXCOORD, MeshModel::MM_VERTTEXCOORD},
      {"vr", Mask::IOM_VERTRADIUS, MeshModel::MM_VERTRADIUS},
      {"fc", Mask::IOM_FACECOLOR, MeshModel::MM_FACECOLOR},
      {"ff", Mask::IOM_FACEFLAGS, 0},
      {"fq", Mask::IOM_FACEQUALITY, MeshModel::MM_FACEQUALITY},
      {"fn", Mask::IOM_FACENORMAL, 0},
      {"wc", Mask::IOM_WEDGCOLOR, MeshModel::MM_WEDGCOLOR},
      {"wn", Mask::IOM_WEDGNORMAL, MeshModel::MM_WEDGNORMAL},
      {"wt", Mask::IOM_WEDGTEXCOORD, MeshModel::MM_WEDGTEXCOORD},
      {"mp", Mask::IOM_BITPOLYGONAL, MeshModel::MM_POLYGONAL},
  };
  return table;
}

/// MeshLab's format plugins resolve textures and materials against the working folder.
class WorkingFolder {
 public:
  explicit WorkingFolder(const QString& folder) : before_(QDir::currentPath()) { QDir::setCurrent(folder); }
  ~WorkingFolder() { QDir::setCurrent(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  QString before_;
};

/// MeshLab's readers do not check every index; a face that points outside the vertices would crash any
/// filter.
bool faces_are_inside(const CMeshO& mesh) {
  if (mesh.face.empty()) return true;
  if (mesh.vert.empty()) return false;
  const CVertexO* first = mesh.vert.data();
  const CVertexO* last = first + mesh.vert.size();
  for (const CFaceO& face : mesh.face)
    for (int corner = 0; corner < 3; ++corner)
      if (face.cV(corner) < first || face.cV(corner) >= last) return false;
  return true;
}

std::size_t count_not_finite(const CMeshO& mesh) {
  std::size_t count = 0;
  for (const CVertexO& vertex : mesh.vert)
    count +=
        !std::isfinite(vertex.cP()[0]) || !std::isfinite(vertex.cP()[1]) || !std::isfinite(vertex.cP()[2]);
  return count;
}

/// Normals and box, as MeshLab's window computes them; normals that the file has are kept, and no face is
/// removed.
void update_derived(MeshModel& mesh, int mask) {
  vcg::tri::UpdateBounding<CMeshO>::Box(mesh.cm);
  if (mesh.cm.fn > 0) {
    vcg::tri::UpdateNormal<CMeshO>::PerFaceNormalized(mesh.cm);
    if ((mask & Mask::IOM_VERTNORMAL) == 0) vcg::tri::UpdateNormal<CMeshO>::PerVertexAngleWeighted(mesh.cm);
  }
  if (mesh.cm.fn > 0 || (mask & Mask::IOM_VERTNORMAL) != 0) mesh.updateDataMask(MeshModel::MM_VERTNORMAL);
}

/// STL has no shared vertices, so without merging nothing in it is connected; MeshLab's window merges too.
QString merge_soup(MeshModel& mesh, std::size_t not_finite) {
  if (not_finite > 0) return "Vertices were not merged, because some have coordinates that are no numbers.";
  const int merged = vcg::tri::Clean<CMeshO>::RemoveDuplicateVertex(mesh.cm, false);
  vcg::tri::Allocator<CMeshO>::CompactEveryVector(mesh.cm);
  if (merged == 0) return QString();
  return QString(
             "STL stores every triangle on its own: %1 vertices at the same positions were merged, "
             "as MeshLab does.")
      .arg(merged);
}

/// Removes the first vertices, which no face uses; all others keep their order.
void remove_front_vertices(CMeshO& mesh, int count) {
  for (int vertex = 0; vertex < count; ++vertex)
    vcg::tri::Allocator<CMeshO>::DeleteVertex(mesh, mesh.vert[std::size_t(vertex)]);
  vcg::tri::Allocator<CMeshO>::CompactVertexVector(mesh);
}

/// `path` is what the plugin opens; `file` is what the user knows.
void call_reader(MeshIOInterface& plugin, const QString& extension, const QFileInfo& file,
                 const QString& path, MeshModel& mesh, int& mask, const RichParameterList& global,
                 const Progress::Receiver& receiver) {
  RichParameterList parameters;
  plugin.initPreOpenParameter(extension, file.fileName(), parameters);
  for (const RichParameter& parameter : global)
    if (!parameters.hasParameter(parameter.name())) parameters.addParam(parameter);
  const QString unify = "MeshLab::IO::STL::UnifyVertices";
  if (parameters.hasParameter(unify)) parameters.setValue(unify, BoolValue(false));
  const WorkingFolder folder(file.absolutePath());
  const CallbackScope callback(receiver);
  plugin.clearErrorString();
  const DialogCloser dialogs;
  const bool opened = plugin.open(extension, path, mesh, mask, parameters, &CallbackScope::callback);
  if (!opened || !dialogs.message().isEmpty()) {
    if (!dialogs.message().isEmpty()) plugin.errorMessage = dialogs.message();
    QString why = plugin.errorMsg().section("Error details:", -1).trimmed();
    if (why.isEmpty()) why = "the contents are not what the format asks for";
    throw CompletionError("reading " + file.fileName().toStdString(), why.toStdString());
  }
}

/// What a layer has: what its file had, and what filters have added since.
int attributes_of(const MeshModel& mesh, const std::map<int, int>& file_masks,
                  const std::map<int, int>& loaded_masks) {
  const auto file_mask = file_masks.find(mesh.id());
  const auto loaded_mask = loaded_masks.find(mesh.id());
  int mask = file_mask == file_masks.end() ? 0 : file_mask->second;
  const int added = mesh.dataMask() & ~(loaded_mask == loaded_masks.end() ? 0 : loaded_mask->second);
  for (const AttributeCode& code : codes())
    if ((added & code.mesh_bits) != 0) mask |= code.file_bits;
  return mask;
}

}  // namespace

QStringList RunnerHost::attribute_codes() {
  QStringList names;
  for (const AttributeCode& code : codes()) names << code.code;
  return names;
}

MeshIOInterface* RunnerHost::State::reader(const QString& extension) {
  if (!manager.allKnowInputFormats.contains("ply")) load_meshlab_plugins("libio_base");
  if (!manager.allKnowInputFormats.contains(extension)) load_meshlab_plugins("libio_");
  return manager.allKnowInputFormats.value(extension, nullptr);
}

MeshIOInterface* RunnerHost::State::writer(const QString& extension) {
  if (!manager.allKnowOutputFormats.contains("ply")) load_meshlab_plugins("libio_base");
  if (!manager.allKnowOutputFormats.contains(extension)) load_meshlab_plugins("libio_");
  return manager.allKnowOutputFormats.value(extension, nullptr);
}

QStringList RunnerHost::readable_formats() {
  state_->load_meshlab_plugins("libio_");
  return state_->manager.allKnowInputFormats.keys();
}

QStringList RunnerHost::writable_formats() {
  state_->load_meshlab_plugins("libio_");
  return state_->manager.allKnowOutputFormats.keys();
}

QStringList RunnerHost::load(const QString& path, const Progress::Receiver& receiver) {
  const QFileInfo file(path);
  const std::string stage = "reading " + file.fileName().toStdString();
  const QString extension = file.suffix().toLower();
  MeshIOInterface* plugin = state_->reader(extension);
  if (plugin == nullptr) throw CompletionError(stage, "MeshLab has no reader for this kind of file");
  MeshModel* mesh = state_->document.addNewMesh(file.absoluteFilePath(), "");
  int mask = 0;
  QStringList notes;
  try {
    const std::string name = QFile::encodeName(path).toStdString();
    std::unique_ptr<TextFile> plain;
    if (extension == "obj") plain = std::make_unique<TextFile>(obj_for_meshlab(name));
    if (extension == "off") plain = std::make_unique<TextFile>(off_for_meshlab(name));
    const QString opened = plain ? QString::fromStdString(plain->path()) : file.fileName();
    call_reader(*plugin, extension.toUpper(), file, opened, *mesh, mask, state_->global_parameters, receiver);
    if (extension == "obj") remove_front_vertices(mesh->cm, obj_stand_ins);
    if (!faces_are_inside(mesh->cm))
      throw CompletionError(stage, "a face refers to a vertex that is not there");
  } catch (const CompletionError&) {
    state_->document.delMesh(mesh);
    throw;
  } catch (const std::exception& error) {
    state_->document.delMesh(mesh);
    throw CompletionError(stage, std::string("the file is damaged (") + error.what() + ")");
  }
  const std::size_t not_finite = count_not_finite(mesh->cm);
  if (not_finite > 0)
    notes << QString("%1 of %2 vertices have coordinates that are no finite numbers.")
                 .arg(not_finite)
                 .arg(mesh->cm.vn);
  if (extension == "stl") notes << merge_soup(*mesh, not_finite);
  if (!plugin->errorMsg().isEmpty()) notes << plugin->errorMsg().section("Error details:", -1).trimmed();
  update_derived(*mesh, mask);
  state_->file_masks[mesh->id()] = mask;
  state_->loaded_masks[mesh->id()] = mesh->dataMask();
  notes.removeAll(QString());
  return notes;
}

QStringList RunnerHost::save(int layer, const QString& path, const SaveOptions& options,
                             const Progress::Receiver& receiver) {
  const QFileInfo file(path);
  const std::string stage = "writing " + file.fileName().toStdString();
  const QString extension = file.suffix().toLower();
  MeshIOInterface* plugin = state_->writer(extension);
  if (plugin == nullptr) throw CompletionError(stage, "MeshLab has no writer for this kind of file");
  MeshModel& mesh = *state_->document.meshList.at(layer);
  vcg::tri::Allocator<CMeshO>::CompactEveryVector(mesh.cm);
  int wanted = 0;
  if (options.attributes) {
    for (const AttributeCode& code : codes())
      if (options.attributes->contains(code.code)) wanted |= code.file_bits;
  } else {
    wanted = attributes_of(mesh, state_->file_masks, state_->loaded_masks);
  }
  int able = 0, usual = 0;
  QString format = file.suffix().toUpper();
  plugin->GetExportMaskCapability(format, able, usual);
  // This release's OFF writer stores flags in place of the polygons' vertex numbers.
  if (extension == "off") able &= ~Mask::IOM_BITPOLYGONAL;
  QStringList lost;
  for (const AttributeCode& code : codes())
    if ((wanted & ~able & code.file_bits) != 0) lost << code.code;
  RichParameterList parameters;
  plugin->initSaveParameter(format, mesh, parameters);
  if (parameters.hasParameter("Binary")) parameters.setValue("Binary", BoolValue(options.binary));
  const WorkingFolder folder(file.absolutePath());
  const CallbackScope callback(receiver);
  plugin->clearErrorString();
  const DialogCloser dialogs;
  if (!plugin->save(format, file.absoluteFilePath(), mesh, wanted & able, parameters,
                    &CallbackScope::callback)) {
    QString why = plugin->errorMsg().section('\n', 1).trimmed();
    if (why.isEmpty()) why = dialogs.message();
    if (why.isEmpty()) why = "MeshLab's writer gave no reason";
    throw CompletionError(stage, why.toStdString());
  }
  return lost;
}

LayerGeometry RunnerHost::geometry(int layer) const {
  const CMeshO& mesh = state_->document.meshList.at(layer)->cm;
  LayerGeometry geometry;
  geometry.vertices.reserve(mesh.vert.size());
  geometry.faces.reserve(mesh.face.size());
  for (const CVertexO& vertex : mesh.vert)
    if (!vertex.IsD()) geometry.vertices.push_back({vertex.cP()[0], vertex.cP()[1], vertex.cP()[2]});
  for (const CFaceO& face : mesh.face)
    if (!face.IsD())
      geometry.faces.push_back({std::uint32_t(vcg::tri::Index(mesh, face.cV(0))),
                                std::uint32_t(vcg::tri::Index(mesh, face.cV(1))),
                                std::uint32_t(vcg::tri::Index(mesh, face.cV(2)))});
  return geometry;
}

}  // namespace host
}  // namespace meshcomplete
