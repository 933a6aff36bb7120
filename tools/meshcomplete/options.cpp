#include "tools/meshcomplete/options.h"

#include <QRegularExpression>
#include <map>

#include "common/host/runner_host.h"
#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/suggest.h"

namespace meshcomplete {
namespace runner {

namespace {

/// Walks along the arguments.
class Parser {
 public:
  explicit Parser(const QStringList& arguments) : arguments_(arguments) {}
  Options run();

 private:
  using Handler = void (Parser::*)(const QString&);

  static const std::map<QString, Handler>& handlers();
  void option(const QString& argument);
  bool at_value() const { return at_ < arguments_.size() && !arguments_[at_].startsWith('-'); }
  QString value(const QString& option, const QString& what);
  QStringList values(const QString& option, const QString& what);

  void inputs(const QString& option);
  void parameter_or_project(const QString& option);
  void output(const QString& option);
  void layer_or_log(const QString& option);
  void attributes(const QString& option);
  void project_output(const QString& option);
  void threads(const QString& option);
  void overwrite(const QString&);
  void filter(const QString& option) {
    options_.steps.push_back({false, value(option, "the name of a filter"), {}});
  }
  void script(const QString& option) {
    options_.steps.push_back({true, value(option, "a script (.mlx)"), {}});
  }
  void dump(const QString& option) { options_.dump_file = value(option, "a file"); }
  void report(const QString& option) { options_.report = value(option, "a file (.json)"); }
  void plugins(const QString& option) { options_.plugin_folders << value(option, "a folder"); }
  void describe(const QString& option) { options_.describe = value(option, "the name of a filter"); }
  void list(const QString&) { options_.list = true; }
  void help(const QString&) { options_.help = true; }
  void version(const QString&) { options_.version = true; }
  void quiet(const QString&) { options_.quiet = true; }

  QStringList arguments_;
  int at_ = 0;
  Options options_;
  bool after_output_ = false;   ///< -l and -m belong to the -o before them
  bool after_project_ = false;  ///< -x belongs to the -w before it
};

const std::map<QString, Parser::Handler>& Parser::handlers() {
  static const std::map<QString, Handler> table = {
      {"-i", &Parser::inputs},         {"-p", &Parser::parameter_or_project},
      {"-s", &Parser::script},         {"-f", &Parser::filter},
      {"-o", &Parser::output},         {"-m", &Parser::attributes},
      {"-om", &Parser::attributes},    {"-l", &Parser::layer_or_log},
      {"-w", &Parser::project_output}, {"-x", &Parser::overwrite},
      {"-d", &Parser::dump},           {"--report", &Parser::report},
      {"--plugins", &Parser::plugins}, {"--describe", &Parser::describe},
      {"--threads", &Parser::threads}, {"--list", &Parser::list},
      {"--help", &Parser::help},       {"-h", &Parser::help},
      {"--version", &Parser::version}, {"--quiet", &Parser::quiet},
      {"-q", &Parser::quiet},
  };
  return table;
}

Options Parser::run() {
  while (at_ < arguments_.size()) option(arguments_[at_++]);
  return options_;
}

void Parser::option(const QString& argument) {
  QString name = argument;
  if (argument.startsWith("--") && argument.contains('=')) {
    name = argument.section('=', 0, 0);
    arguments_.insert(at_, argument.section('=', 1));
  }
  const auto found = handlers().find(name);
  if (found == handlers().end()) {
    if (!argument.startsWith('-'))
      throw UsageError("What is \"" + argument +
                       "\" for? Meshes to read go behind -i, the one to write behind -o.");
    QStringList known;
    for (const auto& handler : handlers()) known << handler.first;
    throw UsageError("There is no option " + name + "." + did_you_mean(name, known) + " See --help.");
  }
  const bool keeps_output = name == "-l" || name == "-m" || name == "-om";
  if (!keeps_output) after_output_ = false;
  if (name != "-x") after_project_ = false;
  (this->*found->second)(name);
}

QString Parser::value(const QString& option, const QString& what) {
  if (at_ >= arguments_.size() || arguments_[at_].isEmpty())
    throw UsageError("Option " + option + " needs " + what + " behind it.");
  if (arguments_[at_].startsWith('-'))
    throw UsageError("Option " + option + " needs " + what + " behind it, not \"" + arguments_[at_] +
                     "\". (A name that starts with a dash: write ./" + arguments_[at_] + ".)");
  return arguments_[at_++];
}

QStringList Parser::values(const QString& option, const QString& what) {
  QStringList found = {value(option, what)};
  while (at_value()) found << arguments_[at_++];
  return found;
}

void Parser::inputs(const QString& option) {
  for (const QString& path : values(option, "a mesh file")) options_.sources.push_back({path, false});
}

void Parser::parameter_or_project(const QString& option) {
  // Values may start with a dash (negative numbers), so the first is taken as it is.
  if (at_ >= arguments_.size()) throw UsageError("Option -p needs NAME=VALUE or a project (.mlp) behind it.");
  do {
    const QString given = arguments_[at_++];
    if (given.contains('=')) {
      if (options_.steps.empty() || options_.steps.back().script)
        throw UsageError("Parameter \"" + given +
                         "\": write the filter it belongs to in front of it (-f NAME -p " + given + ").");
      options_.steps.back().parameters.emplace_back(given.section('=', 0, 0).trimmed(),
                                                    given.section('=', 1));
    } else if (given.endsWith(".mlp", Qt::CaseInsensitive)) {
      options_.sources.push_back({given, true});
    } else {
      throw UsageError("\"" + given + "\" behind " + option +
                       " is neither NAME=VALUE nor a MeshLab project (.mlp).");
    }
  } while (at_value() && arguments_[at_].contains('='));
}

void Parser::output(const QString& option) {
  MeshOutput output;
  output.path = value(option, "a mesh file");
  if (at_value())
    throw UsageError("Option -o takes one file; write -o in front of \"" + arguments_[at_] + "\" too.");
  options_.outputs.push_back(output);
  after_output_ = true;
}

void Parser::layer_or_log(const QString& option) {
  const QString given = value(option, after_output_ ? "a layer (a number, c or x)" : "a log file");
  bool number = false;
  const int index = given.toInt(&number);
  if (after_output_ && (number || given == "c" || given == "x")) {
    LayerChoice& layer = options_.outputs.back().layer;
    layer.kind = number ? LayerChoice::position : given == "c" ? LayerChoice::current : LayerChoice::last;
    layer.index = index;
  } else {
    options_.log_file = given;
    after_output_ = false;
  }
}

void Parser::attributes(const QString& option) {
  if (!after_output_) throw UsageError("Option " + option + " belongs behind -o FILE.");
  const QStringList known = host::RunnerHost::attribute_codes();
  MeshOutput& output = options_.outputs.back();
  for (const QString& code : values(option, "attributes like vc vn fq")) {
    if (code == "sa") {
      output.binary = false;
      continue;
    }
    if (!known.contains(code))
      throw UsageError("There is no mesh attribute \"" + code + "\". They are: " + known.join(' ') +
                       ", and sa for ASCII.");
    if (!output.attributes) output.attributes = QStringList();
    *output.attributes << code;
  }
}

void Parser::project_output(const QString& option) {
  ProjectOutput project;
  project.path = value(option, "a project (.mlp)");
  if (!project.path.endsWith(".mlp", Qt::CaseInsensitive)) project.path += ".mlp";
  options_.projects.push_back(project);
  after_project_ = true;
}

void Parser::overwrite(const QString&) {
  if (!after_project_) throw UsageError("Option -x belongs behind -w PROJECT.mlp.");
  options_.projects.back().overwrite_meshes = true;
}

void Parser::threads(const QString& option) {
  const QString given = value(option, "a number of threads");
  bool number = false;
  const int count = given.toInt(&number);
  if (!number || count < 1 || count > 1024)
    throw UsageError("Option --threads needs a number from 1 to 1024, not \"" + given + "\".");
  options_.threads = count;
}

}  // namespace

Options parse_options(const QStringList& arguments) { return Parser(arguments).run(); }

}  // namespace runner
}  // namespace meshcomplete
