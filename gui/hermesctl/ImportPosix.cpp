// hermesctl session import: a bag of ROS becomes a session of the recorder.
#include "common/progress/Progress.h"
#include "common/recording/DiskError.h"
#include "common/recording/RecordingName.h"
#include "common/recording/Sidecar.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Import.h"
#include "gui/vector/BagDrive.h"
#include "gui/vector/Failure.h"
#include "protocol/mcap/Writer.h"
#include "protocol/messages/Matching.h"
#include "protocol/messages/Motion.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QDir>
#include <QJsonArray>
#include <QUuid>

#include <cmath>
#include <unistd.h>

namespace hermes::ctl {
namespace {

constexpr double metre_variance = 1e-3, turn_variance = 1e-3; // of an odometry, by what it has driven
constexpr double latest_s = 4294967295;                       // that a recording may begin

/// The topics of a drive as the recorder has them.
class ImportedFile {
public:
    explicit ImportedFile(const QString &path)
        : file_(path)
        , isOpen_(file_.open(QIODevice::WriteOnly | QIODevice::NewOnly))
        , writer_(
              [this](std::string_view bytes) {
                  return isOpen_ && file_.write(bytes.data(), qint64(bytes.size())) == qint64(bytes.size());
              },
              "hermesctl") {
        scan_ = channel<ScanMessage>("scanner", "scan2d");
        odometry_ = channel<OdometryMessage>("motorcontrol", "odometry");
        pose_ = channel<PoseMessage>("scanmatcher", "pose");
    }

    /// In the frame of the robot, so that nobody has to be told where the scanner is on it.
    void add(std::uint64_t time_ns, const vectorlib::TimedScan &scan, const vectorlib::Pose2D &mount,
             const std::string &frame) {
        ScanMessage message;
        message.header.turn = scans_++;
        message.header.stamp = scan.stamp;
        message.header.duration_s = vectorlib::lastTime(scan.seconds) - vectorlib::firstTime(scan.seconds);
        message.header.rays = scan.rays;
        message.header.frame = QString::fromStdString(frame);
        for (const auto &point : scan.points) {
            const double c = std::cos(mount.theta), s = std::sin(mount.theta), x = double(point.x),
                         y = double(point.y);
            message.x.push_back(float(mount.x + c * x - s * y));
            message.y.push_back(float(mount.y + s * x + c * y));
        }
        if (!scan.seconds.empty())
            message.t = scan.seconds;
        message.intensity.resize(message.x.size());
        write(scan_, time_ns, scan.stamp, asJson(message));
    }
    void add(std::uint64_t time_ns, const vectorlib::OdometrySample &sample, double since_s) {
        const vectorlib::Pose2D way = before_ ? before_->inverse() * sample.pose : vectorlib::Pose2D();
        way_m_ += std::hypot(way.x, way.y);
        turned_rad_ += std::abs(way.theta);
        before_ = sample.pose;
        OdometryMessage message{sample.pose, sample.twist, {}, since_s};
        message.covariance[0] = message.covariance[4] = metre_variance * way_m_;
        message.covariance[8] = turn_variance * (way_m_ + turned_rad_);
        write(odometry_, time_ns, sample.stamp, asJson(message));
    }
    /// Of the last scan.
    void add(std::uint64_t time_ns, double stamp, const vectorlib::Pose2D &pose) {
        PoseMessage message;
        message.pose = pose;
        message.outcome = "matched";
        message.scan = scans_ - 1;
        message.trust = 1;
        write(pose_, time_ns, stamp, asJson(message));
    }
    /// false: not all could be written.
    bool finish() {
        return isOpen_ && isWhole_ && writer_.finish() && file_.flush() && ::fsync(file_.handle()) == 0;
    }
    QString error() const { return file_.errorString(); }
    quint64 bytes() const { return writer_.bytes(); }
    quint64 scans() const { return scans_; }
    quint64 messages() const { return messages_; }

private:
    template <typename M>
    std::uint16_t channel(const std::string &daemon, const std::string &topic) {
        const std::uint16_t schema =
            writer_.addSchema(daemon + '/' + topic, "jsonschema", compactJson(schemaOf<M>()).toStdString());
        return writer_.addChannel(schema, daemon + '/' + topic, "json",
                                  {{"daemon", daemon}, {"topic", topic}});
    }
    void write(std::uint16_t channel, std::uint64_t time_ns, double stamp, const QJsonValue &data) {
        const QByteArray text = compactJson(data);
        const auto stamp_ns = std::uint64_t(std::llround(std::clamp(stamp, 0.0, latest_s) * 1e9));
        isWhole_ = isWhole_ && writer_.write({channel,
                                              std::uint32_t(messages_++),
                                              time_ns,
                                              stamp_ns,
                                              {text.constData(), std::size_t(text.size())}});
    }

    QFile file_;
    bool isOpen_, isWhole_ = true; ///< isOpen_: before the writer begins
    mcap::Writer writer_;
    std::uint16_t scan_ = 0, odometry_ = 0, pose_ = 0;
    quint64 scans_ = 0, messages_ = 0;
    std::optional<vectorlib::Pose2D> before_;
    double way_m_ = 0, turned_rad_ = 0;
};

/// Where the recorder keeps its sessions, on this computer.
Result<QString> rootOf(Client &recorder, const Arguments &arguments) {
    const auto setting = ask(recorder, arguments, "settings.get", QJsonObject{{"path", "record.folder"}});
    if (!setting)
        return setting.error();
    const QJsonValue told = setting->isObject() ? (*setting)["value"] : *setting;
    QString root = told.toString();
    if (QDir::isRelativePath(root)) { // to where the recorder was started, which what it has tells
        const auto list = ask(recorder, arguments, "record.list");
        const QString folder = list ? list->toArray().first()["folder"].toString() : QString();
        root = folder.isEmpty() ? QDir(root).absolutePath() : QFileInfo(folder).path();
    }
    if (!QFileInfo(root).isDir())
        return diskError(
            root +
                ": there is no such folder of the recorder on this computer; import on the one where it runs",
            root);
    return root;
}

/// All of the drive into an open folder. start_s, end_s: of what was written.
Result<QJsonObject> writeDrive(vector::BagDrive &drive, const QString &folder) {
    const auto &scanner = drive.scanner();
    const vectorlib::Pose2D mount = scanner.mount.value_or(vectorlib::Pose2D());
    const double start_s = double(drive.reader().start_ns()) / 1e9,
                 end_s = double(drive.reader().end_ns()) / 1e9;
    if (!(start_s <= latest_s && end_s <= latest_s))
        return Error(ErrorCode::InvalidParams, "its times are beyond the year 2106");
    const QString name = "recorder-0001.mcap";
    ImportedFile file(QDir(folder).filePath(name));
    Progress progress("importing, scan");
    drive.begin();
    vectorlib::TimedScan scan;
    auto sample = drive.nextSample();
    for (auto time_ns = drive.nextScan(scan); time_ns || sample;) {
        if (sample && (!time_ns || sample->first <= *time_ns)) {
            file.add(sample->first, sample->second, double(sample->first) / 1e9 - start_s);
            sample = drive.nextSample();
            continue;
        }
        file.add(*time_ns, scan, mount, scanner.base);
        if (const auto pose = drive.poseAt(scan))
            file.add(*time_ns, scan.stamp, *pose);
        progress.update(double(file.scans()), double(scanner.messages));
        time_ns = drive.nextScan(scan);
    }
    if (!file.finish())
        return diskError(QString("%1/%2: cannot be written: %3").arg(folder, name, file.error()), folder);
    return QJsonObject{{"format", Sidecar::format},
                       {"logger", "recorder"},
                       {"session", QUuid::createUuid().toString(QUuid::WithoutBraces)},
                       {"start", start_s},
                       {"end", end_s},
                       {"ended", "stopped"},
                       {"complete", true},
                       {"bytes", double(file.bytes())},
                       {"counts", QJsonObject{{"messages", double(file.messages())}}},
                       {"losses", QJsonObject()},
                       {"files", QJsonArray{QJsonObject{{"name", name}, {"bytes", double(file.bytes())}}}}};
}

/// Root gives them to whom the folder of all sessions belongs.
void giveToOwner(const QString &root, const QString &folder) {
    const QFileInfo of(root);
    if (::geteuid() != 0)
        return;
    for (const QString &path : {folder, folder + "/recorder.json", folder + "/recorder-0001.mcap"})
        if (::lchown(QFile::encodeName(path).constData(), of.ownerId(), of.groupId()) != 0)
            note(path + ": belongs to root: " + qt_error_string());
}

Result<void> importInto(vector::BagDrive &drive, const QString &root, const QString &name) {
    const QString folder = QDir(root).filePath(name), draft = QDir(root).filePath("." + name + ".import");
    const auto failed = [&](const QString &what) {
        QDir(draft).removeRecursively();
        return diskError(what, folder);
    };
    if (QFileInfo::exists(folder))
        return diskError(folder + ": it exists already; --name gives the session another name", folder);
    QDir(draft).removeRecursively(); // of an import that was killed
    if (!QDir().mkdir(draft))
        return diskError(draft + ": cannot be made; import as the user of the recorder", draft);
    Result<QJsonObject> sidecar = writeDrive(drive, draft);
    if (!sidecar)
        return failed(sidecar.error().message);
    sidecar->insert("name", name);
    if (const auto written = Sidecar::write(Sidecar::path(draft, "recorder"), *sidecar, true); !written)
        return failed(written.error().message);
    giveToOwner(root, draft);
    return QDir().rename(draft, folder) ? Result<void>() : failed(folder + ": cannot be made");
}

/// Whether the recorder has it: else its folder is that of another computer.
Result<void> expectSession(Client &recorder, const Arguments &arguments, const QString &root,
                           const QString &name) {
    const auto list = ask(recorder, arguments, "session.list");
    if (!list)
        return list.error();
    for (const QJsonValue &session : list->toArray())
        if (session["name"].toString() == name) {
            print(arguments, session, name);
            return {};
        }
    QDir(QDir(root).filePath(name)).removeRecursively();
    return diskError(
        root + ": the recorder keeps its sessions elsewhere; import on the computer where it runs", root);
}

} // namespace

Result<void> importSession(Client &recorder, const Arguments &arguments) {
    const QString path = arguments.words.value(1);
    const QString name = arguments.name.isEmpty() ? QFileInfo(path).completeBaseName() : arguments.name;
    if (const Result<void> fine = checkName("--name", name); !fine)
        return fine;
    const Result<QString> root = rootOf(recorder, arguments);
    if (!root)
        return root.error();
    try {
        vector::BagDrive drive(path.toStdString());
        drive.choose({arguments.topic.toStdString(), {}});
        if (const Result<void> done = importInto(drive, *root, name); !done)
            return done;
        if (const QString notices = QString::fromStdString(drive.notices(false)); !notices.isEmpty())
            note(notices);
    } catch (const vector::Failure &failure) {
        return Error(ErrorCode::InvalidParams, failure.what());
    }
    return expectSession(recorder, arguments, *root, name);
}

} // namespace hermes::ctl
