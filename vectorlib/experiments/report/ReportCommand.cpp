#include "common/progress/Progress.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "gui/vector/SearchOptions.h"
#include "vectorlib/experiments/Commands.h"
#include "vectorlib/experiments/report/Worlds.h"

namespace hermes::experiments {

using vector::aboveZero;
using vector::addOption;
using vector::between;
using vector::example;
using vector::hasExtension;
using vector::OutputOptions;
using vector::OutputSet;
using vector::SearchOptions;
using vector::wholeNumber;

namespace {

constexpr const char *formats[] = {"json", "csv", "svg", "latex"};

struct ReportCommand {
    std::string in;
    std::optional<std::size_t> number;
    bool overall = false, all = false, everyCombination = false;
    std::optional<std::size_t> most;
    std::string format;
    std::optional<int> rays;
    std::optional<double> noise, sigma;
    SearchOptions search;
    std::uint64_t seed = 1;
    OutputOptions output;

    void run() const {
        if (overall + all + number.has_value() != 1)
            throw CLI::ValidationError("--case", "expected one of --case, --all and --overall");
        if (most && !everyCombination)
            throw CLI::ValidationError("--most", "is only for --all-combinations");
        const std::string as = chosenFormat();
        OutputSet files(output.force);
        std::ostream &out = files.open(output.out);
        const ReportWorld world = findWorld(in);
        const ReportSettings settings = chosenSettings(world.world.name);
        if (number) {
            write(out, as, world, settings, reportCase(world.world, checkedNumber(world.world), settings));
        } else {
            Progress progress("case");
            const OverallReport report =
                reportOverall(world.world, settings, [&](std::size_t done, std::size_t among) {
                    progress.update(double(done), double(among));
                });
            if (overall)
                write(out, as, world, settings, report);
            else
                write(out, as, world, settings, CaseReports{report.cases});
        }
        files.commit();
    }

    std::size_t checkedNumber(const World &world) const {
        const std::size_t cases = world.poses.size() - 1;
        if (*number >= cases)
            throw CLI::ValidationError("--case", "found " + std::to_string(*number) + ", expected 0 to " +
                                                     std::to_string(cases - 1) + ": the world has " +
                                                     std::to_string(cases + 1) + " poses");
        return *number;
    }
    std::string chosenFormat() const {
        if (!format.empty())
            return format;
        for (const char *name : formats)
            if (hasExtension(output.out, std::string(".") + name))
                return name;
        return hasExtension(output.out, ".tex") ? "latex" : "json";
    }
    ReportSettings chosenSettings(const std::string &name) const {
        ReportSettings s = settingsFor(name);
        s.scan.seed = seed;
        s.scan.rays = rays.value_or(s.scan.rays);
        s.scan.noise = noise.value_or(s.scan.noise);
        s.scan.sigma = sigma.value_or(s.scan.sigma);
        s.search = search.over(s.search);
        s.everyCombination = everyCombination;
        s.maxCombinations = most.value_or(s.maxCombinations);
        return s;
    }
    template <typename Report>
    static void write(std::ostream &out, const std::string &as, const ReportWorld &world,
                      const ReportSettings &settings, const Report &report) {
        if (as == "csv")
            writeCsv(out, report);
        else if (as == "svg")
            writeSvg(out, world, settings, report);
        else if (as == "latex")
            writeLatex(out, world, settings, report);
        else
            writeJson(out, world, settings, report);
    }
};

} // namespace

void addReportCommand(CLI::App &app) {
    auto command = std::make_shared<ReportCommand>();
    CLI::App *sub = app.add_subcommand(
        "report", "Register consecutive scans of a world and tell how well that went (thesis appendices)");
    sub->add_option("WORLD", command->in,
                    "World: JSON with edges and poses, or pillars, quadratic, cutsquare or oblique")
        ->required();
    addOption(*sub, "--case N", command->number, wholeNumber(0, 1e6), "Scans N and N + 1 with all solutions");
    sub->add_flag("--overall", command->overall, "All consecutive scans with their accepted solutions");
    sub->add_flag("--all", command->all, "The case reports of all consecutive scans");
    sub->add_flag("--all-combinations", command->everyCombination,
                  "Every reliable, unambiguous combination by the published rules; accepted are permitted "
                  "ones of little discrepancy");
    addOption(*sub, "--most N", command->most, wholeNumber(1, 10000),
              "With --all-combinations: the N longest of a case (100)");
    addOption(*sub, "--format KIND", command->format, CLI::IsMember({"json", "csv", "svg", "latex"}),
              "json, csv, svg or latex; else by the extension of --out, else json");
    constexpr const char *scans = "Scans";
    addOption(*sub, "--rays N", command->rays, wholeNumber(3, 1e6), "Rays of a scan (2000)")->group(scans);
    addOption(*sub, "--noise M", command->noise, between(0, 1e3),
              "Standard deviation of the range, metres (0.01)")
        ->group(scans);
    addOption(*sub, "--sigma M", command->sigma, aboveZero(),
              "Largest error of the vectorization, metres (0.03)")
        ->group(scans);
    addOption(*sub, "--seed I", command->seed, "The same seed gives the same scans")
        ->capture_default_str()
        ->group(scans);
    command->search.addTo(*sub, "0.2; quadratic 0.5");
    command->output.addTo(*sub, false);
    sub->footer(example("hermes-experiments report pillars --case 0 --out case.tex"));
    sub->callback([command] { command->run(); });
}

} // namespace hermes::experiments
