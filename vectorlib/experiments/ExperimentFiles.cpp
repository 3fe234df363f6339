#include "vectorlib/experiments/ExperimentCommand.h"

#include "common/platform/Program.h"
#include "common/progress/Progress.h"
#include "common/world/World.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/LatexExport.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace hermes::experiments {

using vector::Failure;
using vector::Input;
using vector::valueOrFail;

namespace fs = std::filesystem;

namespace {

constexpr const char *figuresEnd = "-figures.json";

} // namespace

void ExperimentCommand::tell(std::ostream &json, const nlohmann::ordered_json &summary) {
    const std::string text = summary.dump(2) + '\n';
    json << text;
    std::cout << text;
}

std::ostream &ExperimentCommand::open(OutputSet &files, const std::string &suffix) const {
    return files.open((fs::u8path(folder) / (name + suffix)).u8string());
}

World ExperimentCommand::world(const std::string &place) const {
    Outcome<World> found = readWorld((fs::u8path(worlds) / (place + ".json")).u8string());
    if (!found)
        throw Failure(found.error() + "; --worlds names the folder of the worlds");
    found->name = place; // whatever it calls itself: the name goes into scripts and documents
    return *found;
}

std::vector<World> ExperimentCommand::allWorlds() const {
    std::vector<World> all;
    for (const char *place : {"corner", "cutsquare", "home", "oblique", "pillars", "quadratic"})
        all.push_back(world(place));
    return all;
}

vectorlib::CarmenLog ExperimentCommand::readLog() const {
    if (logs.size() != 1)
        throw CLI::ValidationError("--log", "the experiment " + name + " needs the name of a CARMEN log");
    return readLog(logs[0]);
}

vectorlib::CarmenLog ExperimentCommand::readLog(const std::string &file) {
    Input input(file);
    if (input.isCapture())
        throw Failure(file + ": found a capture, this experiment needs a CARMEN log");
    return valueOrFail(vectorlib::readCarmenLog(input.stream(), input.name()));
}

vectorlib::CarmenLog ExperimentCommand::readPairs(const std::string &file, const PairsOptions &of) const {
    vectorlib::CarmenLog log = readLog(file);
    if (of.pairsOf(log).empty())
        throw Failure(file + ": found " + std::to_string(log.scans.size()) + " scans and among them no pair" +
                      (of.half == PairHalf::Both ? "" : " of this half") + ", expected more than --every " +
                      std::to_string(of.every));
    return log;
}

std::vector<std::string> ExperimentCommand::setNames(const std::vector<std::string> &files) {
    std::vector<std::string> names;
    for (const std::string &file : files) {
        fs::path path = fs::u8path(file).filename();
        if (path.extension() == ".gz")
            path = path.stem();
        std::string name = path.stem().u8string();
        for (char &c : name)
            if (!(c >= '0' && c <= '9') && !(c >= 'A' && c <= 'Z') && !(c >= 'a' && c <= 'z') && c != '.')
                c = '-';
        const auto other = std::find(names.begin(), names.end(), name);
        if (other != names.end())
            throw Failure(file + ": would be called " + name + " as is " +
                          files[std::size_t(other - names.begin())] + ", expected logs of different names");
        names.push_back(name);
    }
    return names;
}

void ExperimentCommand::draw(OutputSet &files, const Figures &figures,
                             std::vector<NamedPicture> named) const {
    vectorlib::LatexExport document(open(files, ".tex"), name);
    for (auto &[which, picture] : named) {
        picture.write(open(files, (which.empty() ? "" : "-" + which) + ".svg"));
        document.picture(picture, {14, 9});
    }
    for (const Table &table : figures.tables)
        document.table(table);
    const nlohmann::json all = figures;
    for (const auto &[kind, some] : all.items())
        for (const auto &figure : some) {
            const std::string file = name + '-' + figure.at("name").get<std::string>();
            const auto exists = [&file](const char *end, const char *command) {
                return "\\IfFileExists{" + file + end + "}{" + command + '{' + file + end + "}}{";
            };
            document.latex(exists(".pgf", "\\input") + exists(".pdf", "\\includegraphics[width=14cm]") +
                           vectorlib::latexText(figure.at("title").get<std::string>()) +
                           ": nothing is drawn.}}\n\n\\bigskip\n");
        }
    document.finish();
    if (!figures.plots.empty() || !figures.surfaces.empty() || !figures.spaces.empty())
        open(files, figuresEnd) << all << '\n';
}

void ExperimentCommand::drawFigures() const {
    const std::string figures = (fs::u8path(folder) / (name + figuresEnd)).u8string();
    if (!fs::exists(fs::u8path(figures)))
        return;
    const std::string script =
        (programFile().parent_path().parent_path() / "share" / "hermes" / "experiments" / "plot.py")
            .u8string();
    std::vector<std::string> arguments{figures};
    if (force)
        arguments.emplace_back("--force");
    if (Progress::isJson())
        arguments.emplace_back("--json");
    std::cout.flush();
    becomeProgram(script, arguments);
    std::cerr << "hermes-experiments: the plots are not drawn, the script " << script
              << " does not run here; python3 and matplotlib draw them by it from " << figures << '\n';
}

} // namespace hermes::experiments
