#include "daemons/supervisor/SetupProposal.h"

#include "common/Project.h"
#include "common/interface/InterfaceUrl.h"
#include "common/settings/DottedPath.h"
#include "daemons/supervisor/SupervisedProcess.h"
#include "protocol/drive/ArduinoDevice.h"
#include "protocol/drive/OpenCrDevice.h"
#include "protocol/roboclaw/Command.h"

#include <QFileInfo>
#include <QJsonArray>
#include <algorithm>
#include <map>

namespace hermes::supervisor {
namespace {

/// A controller on a line.
struct Controller {
    QString path; ///< that is written
    QString device;
    int baud;
    int address;
    bool anyAddress;
};

QString urlOf(const QString &path, int baud) {
    return QString("serial://%1?baud=%2").arg(path).arg(baud);
}

/// The device that a URL names, whatever its name is; empty: none, or no serial line.
QString deviceOf(const QString &text) {
    const auto url = InterfaceUrl::parse(text);
    if (!url || url->scheme != "serial" || url->path.isEmpty())
        return {};
    const QString device = QFileInfo(url->path).canonicalFilePath();
    return device.isEmpty() ? url->path : device;
}

/// A motor controller of another kind, one of which drives two wheels.
struct Base {
    const char *kind;
    double timeout_s;
    const char *note;
};

const Base *baseOf(const FoundSerial &line) {
    static constexpr Base bases[] = {
        {"arduino", drive::ArduinoDevice::timeout_s,
         "an Arduino stops by itself only 2 s after its last command"},
        {"vesc", 1,
         "VESC Tool sets how soon a VESC stops by itself (1 s as it comes), and whether it then rolls; "
         "controllers.1.address is the CAN id of the second VESC, 255 where there is none"},
        {"opencr", drive::OpenCrDevice::timeout_s, "an OpenCR stops by itself 0.5 s after its last command"},
        {"roboteq", drive::DeviceSettings().timeout_s, "a Roboteq needs closed-loop speed on both channels"}};
    const auto base = std::find_if(std::begin(bases), std::end(bases),
                                   [&](const Base &each) { return line.kind == each.kind; });
    return base == std::end(bases) ? nullptr : base;
}

std::vector<Controller> controllersAt(const std::vector<FoundSerial> &lines) {
    std::vector<Controller> found;
    for (const FoundSerial &line : lines) {
        if (line.kind != "roboclaw")
            continue;
        for (const int address : line.addresses) {
            found.push_back({line.path, line.device, line.baud, address, line.anyAddress});
            if (line.anyAddress)
                break;
        }
    }
    return found;
}

QJsonArray processesOf(const QJsonObject &base) {
    const QJsonValue processes = valueAt(base, "supervisor.processes");
    return processes.isArray() ? processes.toArray() : usualProcesses();
}

bool startsSimulator(const QJsonArray &processes) {
    return std::any_of(processes.begin(), processes.end(), [](const QJsonValue &process) {
        return process["name"] == "simulator" && process["autostart"].toBool();
    });
}

class Proposer {
public:
    Proposer(const QJsonObject &base, QString folder)
        : base_(base)
        , folder_(std::move(folder))
        , before_(processesOf(base)) {}

    Proposal make(const Findings &all) {
        const Findings findings = withoutSimulated(all);
        busy(findings);
        motors(findings.serial);
        receivers(findings.serial);
        scanner(findings.serial);
        lidar(findings.lidars);
        if (processes_ != before_)
            set("supervisor.processes", processes_);
        if (const QJsonValue odometry = valueAt(base_, "scanmatcher.odometry.address");
            drives_ && odometry.toString().isEmpty())
            set("scanmatcher.odometry.address", QString("127.0.0.1:%1").arg(defaultPort("motorcontrol")));
        return {changed(), {}, proposal_.notes};
    }

private:
    /// The simulator's devices are those of a robot only where it is to run, and nothing else is there.
    Findings withoutSimulated(Findings findings) {
        const auto isReal = [](const auto &one) { return !one.simulated; };
        const auto isDevice = [](const FoundSerial &line) {
            return !line.simulated &&
                   (line.kind == "roboclaw" || baseOf(line) || line.kind == "nmea" || line.kind == "scanner");
        };
        const auto &[serial, lidars, problems, restarted] = findings;
        const bool isRobot = std::any_of(serial.begin(), serial.end(), isDevice) ||
                             std::any_of(lidars.begin(), lidars.end(), isReal);
        const bool simulates = startsSimulator(processes_);
        if (simulates && !isRobot)
            return findings;
        if (simulates)
            note("the simulator starts with the supervisor; the sample of a robot ends it");
        const auto leaveOut = [&](auto &devices) {
            devices.erase(std::stable_partition(devices.begin(), devices.end(), isReal), devices.end());
        };
        leaveOut(findings.serial);
        leaveOut(findings.lidars);
        return findings;
    }

    /// What is found below may be less than there is.
    void busy(const Findings &findings) {
        for (const FoundSerial &line : findings.serial)
            if (line.kind == "in_use")
                note(QString("%1 was not searched: another program uses it").arg(line.device));
        for (const QString &problem : findings.problems)
            note("not searched: " + problem);
    }

    void motors(const std::vector<FoundSerial> &lines) {
        const std::vector<Controller> found = controllersAt(lines);
        const auto numbers = numbered(found);
        if (found.empty() && base(lines))
            return;
        if (found.empty())
            note("no motor controllers were found: RoboClaws, VESCs, Roboteqs, an OpenCR or an Arduino");
        else if (found.size() != 2)
            note(QString("%1 RoboClaws were found, two drive a robot (each needs an address of its own on "
                         "its line)")
                     .arg(found.size()));
        if (numbers.size() < 2)
            return;
        for (const auto &[number, controller] : numbers) {
            const QString group = QString("motorcontrol.controllers.%1.").arg(number);
            set(group + "url", urlOf(controller.path, controller.baud));
            set(group + "address", controller.address);
        }
        if (valueAt(base_, "motorcontrol.controllers.kind").toString("roboclaw") != "roboclaw") {
            setKind("roboclaw", drive::DeviceSettings().timeout_s);
            note("frame.layout stays as it is: it has to be that of a base with two RoboClaws");
        }
        start("motorcontrol");
        drives_ = true;
    }

    /// The first of them drives two wheels; false: there is none.
    bool base(const std::vector<FoundSerial> &lines) {
        const auto line = std::find_if(lines.begin(), lines.end(), baseOf);
        if (line == lines.end())
            return false;
        const Base &found = *baseOf(*line);
        setKind(found.kind, found.timeout_s);
        set("motorcontrol.controllers.1.url", urlOf(line->path, line->baud));
        set("motorcontrol.frame.layout", "two_wheels");
        note(QString(found.note) +
             " (docs/safety.md); frame.*, frame.counts_per_turn and pid.qpps are those of your base");
        start("motorcontrol");
        drives_ = true;
        return true;
    }

    /// As many as the wheels name: a number that was set may be that of another base.
    void setKind(const char *kind, double timeout_s) {
        set("motorcontrol.controllers.kind", kind);
        set("motorcontrol.controllers.timeout_s", timeout_s);
        if (valueAt(base_, "motorcontrol.controllers.count").toInt() != 0)
            set("motorcontrol.controllers.count", 0);
    }

    /// Which is which stays as it is. Others get the numbers that are left, where it is clear which they are.
    std::map<int, Controller> numbered(std::vector<Controller> found) const {
        std::map<int, Controller> numbers;
        for (const int number : {1, 2}) {
            const QString group = QString("motorcontrol.controllers.%1.").arg(number);
            const QString device = deviceOf(valueAt(base_, group + "url").toString(roboclaw::usualLine));
            const int address = valueAt(base_, group + "address").toInt(roboclaw::firstAddress + number - 1);
            const auto same = std::find_if(found.begin(), found.end(), [&](const Controller &one) {
                return one.device == device && (one.anyAddress || one.address == address);
            });
            if (same == found.end())
                continue;
            same->address = address;
            numbers.emplace(number, *same);
            found.erase(same);
        }
        if (numbers.size() + found.size() != 2)
            return numbers;
        for (const Controller &other : found)
            numbers.emplace(numbers.count(1) ? 2 : 1, other);
        return numbers;
    }

    void receivers(const std::vector<FoundSerial> &lines) {
        QJsonArray ports = valueAt(base_, "seriallogger.ports").toArray();
        const auto has = [&ports](const auto &isIt) { return std::any_of(ports.begin(), ports.end(), isIt); };
        for (const FoundSerial &line : lines) {
            if (line.kind != "nmea")
                continue;
            start("seriallogger");
            if (has([&](const QJsonValue &port) { return deviceOf(port["url"].toString()) == line.device; }))
                continue;
            QString name = "gps";
            for (int number = 2; has([&](const QJsonValue &port) { return port["name"] == name; }); ++number)
                name = QString("gps%1").arg(number);
            ports.append(QJsonObject{{"name", name}, {"url", urlOf(line.path, line.baud)}, {"view", "nmea"}});
        }
        if (ports != valueAt(base_, "seriallogger.ports").toArray())
            set("seriallogger.ports", ports);
    }

    /// The first of them; the matcher takes its scans.
    void scanner(const std::vector<FoundSerial> &lines) {
        for (const FoundSerial &line : lines) {
            if (line.kind != "scanner")
                continue;
            if (hasScanner_) {
                note(QString("there is a scanner at %1, too; one is taken").arg(line.path));
                continue;
            }
            hasScanner_ = true;
            set("scanner.scanner.url", "serial://" + line.path);
            set("scanner.scanner.model", line.model);
            set("scanmatcher.source.address", QString("127.0.0.1:%1").arg(defaultPort("scanner")));
            start("scanner");
            start("scanmatcher");
        }
    }

    void lidar(const std::vector<FoundLidar> &lidars) {
        if (lidars.empty() && hasScanner_)
            return;
        if (lidars.empty())
            return note("no packets of a lidar were found, nor a scanner on a line");
        if (lidars.size() > 1)
            note(QString("%1 lidars send packets; that at %2 is taken")
                     .arg(lidars.size())
                     .arg(lidars.front().address));
        const FoundLidar &first = lidars.front();
        if (first.key.isEmpty())
            note(QString("the lidar at %1 is of an unknown model").arg(first.address));
        else
            set("velodynelogger.decode.model", first.key);
        start("velodynelogger");
        start("scanmatcher");
    }

    /// A process that starts with the supervisor, with its settings file.
    void start(const QString &name) {
        for (int i = 0; i < processes_.size(); ++i) {
            QJsonObject entry = processes_[i].toObject();
            if (entry["name"].toString() != name)
                continue;
            entry["autostart"] = true;
            if (!entry.contains("arguments"))
                entry["arguments"] = argumentsOf(name);
            processes_[i] = entry;
            return;
        }
        processes_.append(QJsonObject{{"name", name}, {"arguments", argumentsOf(name)}, {"autostart", true}});
    }
    QJsonArray argumentsOf(const QString &name) const {
        return {"--config", QString("%1/%2.json").arg(folder_, name)};
    }

    /// What was set and is not so already.
    QJsonObject changed() const {
        QJsonObject changes;
        for (const QString &path : leafPaths(proposal_.settings))
            if (const QJsonValue value = valueAt(proposal_.settings, path); value != valueAt(base_, path))
                changes = withValueAt(changes, path, value);
        return changes;
    }

    void set(const QString &path, const QJsonValue &value) {
        proposal_.settings = withValueAt(proposal_.settings, path, value);
    }
    void note(const QString &text) { proposal_.notes.append(text); }

    const QJsonObject base_;
    const QString folder_;
    const QJsonArray before_;
    QJsonArray processes_ = before_;
    Proposal proposal_;
    bool drives_ = false, hasScanner_ = false;
};

} // namespace

Proposal propose(const Findings &findings, const QJsonObject &base, const QString &folder) {
    return Proposer(base, folder).make(findings);
}

} // namespace hermes::supervisor
