#include "daemons/supervisor/SetupProposal.h"

#include "common/settings/DottedPath.h"
#include "protocol/roboclaw/Command.h"

#include <QHostAddress>
#include <QJsonArray>
#include <algorithm>

namespace hermes::supervisor {
namespace {

/// A controller on a line.
struct Controller {
    QString url;
    int address;
};

QString urlOf(const FoundSerial &line) {
    return QString("serial://%1?baud=%2").arg(line.path).arg(line.baud);
}

class Proposer {
public:
    Proposer(const QJsonObject &base, QString folder)
        : base_(base)
        , folder_(std::move(folder)) {}

    Proposal make(const Findings &findings) {
        motors(findings.serial);
        receivers(findings.serial);
        lidar(findings.lidars);
        if (processes_ != base_["supervisor"].toObject()["processes"].toArray())
            proposal_.settings["supervisor"] = QJsonObject{{"processes", processes_}};
        return proposal_;
    }

private:
    void motors(const std::vector<FoundSerial> &lines) {
        std::vector<Controller> found;
        for (const FoundSerial &line : lines) {
            if (line.kind != "roboclaw")
                continue;
            for (const int address : line.addresses) {
                found.push_back({urlOf(line), address});
                if (line.anyAddress)
                    break;
            }
        }
        if (found.size() != 2)
            note(QString("%1 RoboClaws were found, two drive a robot (each needs an address of its own on "
                         "its line)")
                     .arg(found.size()));
        if (found.size() < 2)
            return;
        const QString first = valueAt(base_, "motorcontrol.controllers.1.url").toString();
        if (found[1].url == first) // which is which stays as it is
            std::swap(found[0], found[1]);
        for (int i = 0; i < 2; ++i) {
            const QString group = QString("motorcontrol.controllers.%1.").arg(i + 1);
            set(group + "url", found[std::size_t(i)].url);
            set(group + "address", found[std::size_t(i)].address);
        }
        start("motorcontrol");
    }

    void receivers(const std::vector<FoundSerial> &lines) {
        QJsonArray ports = valueAt(base_, "seriallogger.ports").toArray();
        const auto has = [&ports](const char *member, const QString &value) {
            return std::any_of(ports.begin(), ports.end(),
                               [&](const QJsonValue &port) { return port[QLatin1String(member)] == value; });
        };
        for (const FoundSerial &line : lines) {
            if (line.kind != "nmea")
                continue;
            start("seriallogger");
            if (has("url", urlOf(line)))
                continue;
            QString name = "gps";
            for (int number = 2; has("name", name); ++number)
                name = QString("gps%1").arg(number);
            ports.append(QJsonObject{{"name", name}, {"url", urlOf(line)}, {"view", "nmea"}});
        }
        if (ports != valueAt(base_, "seriallogger.ports").toArray())
            set("seriallogger.ports", ports);
    }

    void lidar(const std::vector<FoundLidar> &lidars) {
        if (lidars.empty())
            return note("no lidar sends packets to this computer");
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

    void set(const QString &path, const QJsonValue &value) {
        proposal_.settings = withValueAt(proposal_.settings, path, value);
    }
    void note(const QString &text) { proposal_.notes.append(text); }

    const QJsonObject base_;
    const QString folder_;
    QJsonArray processes_ = base_["supervisor"].toObject()["processes"].toArray();
    Proposal proposal_;
};

} // namespace

Proposal propose(const Findings &findings, const QJsonObject &base, const QString &folder) {
    return Proposer(base, folder).make(findings);
}

} // namespace hermes::supervisor
