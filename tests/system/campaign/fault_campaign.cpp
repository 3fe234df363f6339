// Draws cases of what may break under a driving robot, and what its client does meanwhile, drives through
// them on a clock of its own, and checks that the robot stands when it must (see StandJudge). See --help.
#include "Trial.h"

#include "daemons/simulator/MotorKinds.h"

#include <chrono>
#include <cstdio>
#include <cstring>

using namespace campaign;

namespace {

constexpr const char *usage =
    R"(Usage: fault_campaign [--cases N] [--seed N] [--kind KIND] [--keep-going]

Drives N cases (150), each drawn from its number, from --seed on (1). A case that fails is made as short as it may be
and still fails, and printed. --seed alone drives that one. KIND is that of motors.kind and controllers.kind (roboclaw).
)";

/// The same case with something left out or as usual, all ways.
std::vector<Case> shorter(const Case &c) {
    std::vector<Case> all;
    const auto add = [&](const auto &change) {
        Case other = c;
        change(other);
        all.push_back(other);
    };
    for (std::size_t i = 0; i < c.faults.size(); ++i)
        add([i](Case &o) { o.faults.erase(o.faults.begin() + int(i)); });
    for (std::size_t i = 0; i < c.steps.size(); ++i)
        add([i](Case &o) { o.steps.erase(o.steps.begin() + int(i)); });
    if (c.movesAtFirst)
        add([](Case &o) { o.movesAtFirst = false; });
    if (c.resets)
        add([](Case &o) { o.resets = false; });
    if (c.stamps)
        add([](Case &o) { o.stamps = false; });
    if (c.twoLines)
        add([](Case &o) {
            o.twoLines = false;
            for (Fault &fault : o.faults) {
                if (fault.device == "line2")
                    fault.device = "line1";
            }
        });
    if (c.firmware != "4.2.8")
        add([](Case &o) { o.firmware = "4.2.8"; });
    if (c.vy != 0 || c.omega != 0)
        add([](Case &o) { o.vy = o.omega = 0; });
    if (c.lease_s != 1)
        add([](Case &o) { o.lease_s = 1; });
    for (const QString &group : c.settings.keys()) {
        const QJsonObject values = c.settings[group].toObject();
        for (const QString &name : values.keys())
            add([&](Case &o) {
                QJsonObject fewer = values;
                fewer.remove(name);
                o.settings[group] = fewer;
            });
        if (values.isEmpty())
            add([&](Case &o) { o.settings.remove(group); });
    }
    return all;
}

/// Failures that are the same but for their figures.
std::string kindOf(const std::string &failure) {
    for (const char *kind :
         {" turns with ", "without a time-out", "does not drive again", "nothing is wrong"}) {
        if (failure.find(kind) != std::string::npos)
            return kind;
    }
    return failure;
}

bool failsAlike(const Case &c, const std::string &failure) {
    try {
        return kindOf(run(c).failure) == kindOf(failure);
    } catch (const std::exception &) {
        return false; // settings that do not go together
    }
}

Case shrunk(Case c, const std::string &failure) {
    for (bool shrinks = true; shrinks;) {
        shrinks = false;
        for (const Case &candidate : shorter(c)) {
            if (!failsAlike(candidate, failure))
                continue;
            c = candidate;
            shrinks = true;
            break;
        }
    }
    return c;
}

struct Summary {
    std::string kind;
    int cases = 0, failures = 0, stops = 0;
    std::set<std::string> faults, actions;
    std::map<std::string, int> beyond;
    std::map<std::string, double> slowest;

    void add(const Case &c, const Outcome &outcome) {
        ++cases;
        stops += outcome.stops;
        for (const Fault &fault : c.faults)
            faults.insert(sortOf(fault));
        for (const Step &step : c.steps)
            actions.insert(step.action);
        for (const std::string &what : outcome.beyond)
            ++beyond[what];
        for (const auto &[how, seconds] : outcome.slowest)
            slowest[how] = std::max(slowest[how], seconds);
    }
    void print(double seconds) const {
        std::printf(
            "%d of %d cases as they should, %d times the robot had to stand; %zu of %d faults and %zu of %zu "
            "actions of clients, %.0f s\n",
            cases - failures, cases, stops, faults.size(), everyFault(kind).size(), actions.size(),
            everyAction().size(), seconds);
        for (const auto &[how, most] : slowest)
            std::printf("  until all stood, without braking, where a controller %s: %.2f s at most\n",
                        how.c_str(), most);
        for (const auto &[what, count] : beyond)
            std::printf("  what software cannot promise: a controller %s, and turned on: in %d cases\n",
                        what.c_str(), count);
    }
};

void tell(const Case &c, const std::string &failure) {
    const Case least = shrunk(c, failure);
    std::printf("case %llu fails: %s\n%s  -> %s\n", static_cast<unsigned long long>(c.seed), failure.c_str(),
                least.script().c_str(), run(least).failure.c_str());
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
    long cases = 0;
    std::uint64_t seed = 0;
    std::string kind = "roboclaw";
    int most = 5; // failures that are told
    for (int i = 1; i < argc; ++i) {
        const bool value = i + 1 < argc;
        if (!std::strcmp(argv[i], "--cases") && value)
            cases = std::atol(argv[++i]);
        else if (!std::strcmp(argv[i], "--seed") && value)
            seed = std::strtoull(argv[++i], nullptr, 10);
        else if (!std::strcmp(argv[i], "--kind") && value)
            kind = argv[++i];
        else if (!std::strcmp(argv[i], "--keep-going"))
            most = 1000;
        else {
            std::fputs(usage, stderr);
            return 2;
        }
    }
    if (hermes::simulator::motorKind(kind).name != kind) {
        std::fprintf(stderr, "fault_campaign: --kind %s: no motor controllers are called so\n%s",
                     kind.c_str(), usage);
        return 2;
    }
    if (cases == 0)
        cases = seed == 0 ? 150 : 1;
    seed = seed == 0 ? 1 : seed;
    const auto began = std::chrono::steady_clock::now();
    Summary summary;
    summary.kind = kind;
    for (long i = 0; i < cases; ++i) {
        const Case c = Case::draw(seed + std::uint64_t(i), kind);
        if (cases == 1)
            std::printf("case %llu\n%s", static_cast<unsigned long long>(c.seed), c.script().c_str());
        const Outcome outcome = run(c);
        summary.add(c, outcome);
        if (outcome.failure.empty())
            continue;
        if (++summary.failures <= most)
            tell(c, outcome.failure);
    }
    summary.print(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    return summary.failures == 0 ? 0 : 1;
}
