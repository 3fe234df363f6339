#pragma once

#include "common/client/Client.h"
#include "common/ros/RobotModel.h"
#include "protocol/ros/Cdr.h"
#include "protocol/wire/Fields.h"

namespace hermes::ros {

/// "RIHS01_...", of the text that hashedTextOf() gives. Source: REP 2016.
QByteArray typeHash(const std::string &hashedText);

/// What a writer of DDS offers, or a reader asks for.
struct Quality {
    bool isReliable = true;
    bool isLatched = false; ///< "transient local": who comes later gets what was written last
    int depth = 5;          ///< samples that are kept; 0: all, up to 1,000
    double lifespan_s = 0;  ///< after which a sample is void; 0: never
};

/// What goes with a message of Hermes.
struct Told {
    const QString &daemon; ///< that told it
    double stamp = 0;      ///< when it was true, seconds since the epoch
    const RobotModel &robot;
};

/// Makes the messages of one ROS topic.
class Translator {
public:
    virtual ~Translator() = default;

    /// Takes a message; true: cdr has the bytes that are to be written now. problem says what could not be
    /// read.
    virtual bool take(const TopicUpdate &update, const Told &told, std::string &cdr, QString &problem) = 0;
    /// Called about once a second; the same. now: seconds since the epoch.
    virtual bool refresh(const RobotModel &robot, double now, std::string &cdr) {
        Q_UNUSED(robot)
        Q_UNUSED(now)
        Q_UNUSED(cdr)
        return false;
    }
    /// Of a daemon whose connection has ended.
    virtual void lose(const QString &daemon) { Q_UNUSED(daemon) }
};

/// A row of the table: topics of Hermes that become one of ROS.
struct Mapping {
    QStringList topics;
    QString rosTopic;       ///< "scan"
    std::string type;       ///< "sensor_msgs/msg/LaserScan"
    std::string definition; ///< of the type, as bags have it
    QByteArray hash;        ///< of the type: "RIHS01_..."
    Quality quality;
    /// Each daemon has one of its own; the first is known by the plain name, others below their own. Else
    /// what all tell goes to one.
    bool isOfEach = true;
    std::function<std::unique_ptr<Translator>()> make;

    /// The topic of a daemon: "scan", or "scanner/scan" of one that is not the first to have it.
    QString nameOf(const QString &daemon, bool isFirst) const;
};

/// All of them.
const std::vector<Mapping> &mappings();

/// Makes each message of the type In, by convert, one of the type Out. convert is a function object that may
/// keep what it needs; false: none is to be written.
template <typename In, typename Out, typename Convert>
class Each : public Translator {
public:
    bool take(const TopicUpdate &update, const Told &told, std::string &cdr, QString &problem) override {
        ReadReport report;
        const std::optional<In> in = readMessage<In>(update.data, report);
        if (!in)
            problem = report.text();
        if (!in || !convert_(*in, told, out_))
            return false;
        toCdr(out_, cdr);
        return true;
    }

private:
    Convert convert_;
    Out out_; // its memory is used again
};

} // namespace hermes::ros
