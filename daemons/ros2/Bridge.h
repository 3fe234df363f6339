#pragma once

#include "common/daemon/RobotDaemons.h"
#include "common/ros/Mapping.h"
#include "daemons/ros2/NodeGraph.h"

#include <QElapsedTimer>
#include <deque>

namespace hermes::ros2 {

/// Tells ROS what the daemons of the robot tell. A topic of Hermes is asked for only while somebody reads
/// what is made of it; what is latched is always kept ready.
class Bridge : public QObject {
public:
    struct Options {
        ParticipantOptions network;
        GraphForm graph = GraphForm::Auto;
        QString space;             ///< "/robot1", or empty
        QString framePrefix;       ///< "robot1/", or empty
        bool tellsReplays = false; ///< what is replayed and nothing else, with /clock; else all but that
    };

    static Result<std::unique_ptr<Bridge>> open(const Options &options, RobotDaemons &daemons);
    ~Bridge() override;

    Participant &participant() { return *participant_; }
    NodeGraph &graph() { return graph_; }
    const ros::RobotModel &robot() const { return robot_; }
    /// "scan" becomes "rt/robot1/scan".
    QString ddsTopic(const QString &name) const;
    /// Of whoever else has them: they are told in the graph.
    void addEndpoints(const std::vector<Guid> &readers, const std::vector<Guid> &writers);
    const QString &space() const { return options_.space; } ///< "/robot1", or empty
    /// What a latched topic holds, as CDR; empty: nothing yet.
    std::string latched(const QString &topic) const;

    /// How many topics there are, how many have readers, what was written and could not be.
    struct Counts {
        int topics = 0, read = 0;
        quint64 written = 0, unreadable = 0, leftOut = 0, dropped = 0;
        QString lastProblem;
    };
    Counts counts() const;

private:
    /// A topic of ROS.
    struct Outlet {
        const ros::Mapping *mapping;
        QString name;   ///< "scan"
        QString daemon; ///< whose; empty: all that have it
        std::unique_ptr<Writer> writer;
        std::unique_ptr<ros::Translator> translator;
        std::string last; ///< a latched state: what was written last
    };
    /// A topic of a daemon, and what is made of it.
    struct Feed {
        RobotDaemons::Daemon *daemon;
        QString topic;
        std::vector<Outlet *> outlets;
        int handle = 0; ///< of the subscription; 0: there is none
        quint64 dropped = 0;
    };

    Bridge(const Options &options, RobotDaemons &daemons, std::unique_ptr<Participant> participant);
    void greet(RobotDaemons::Daemon *daemon);
    void receive();
    void attach(RobotDaemons::Daemon *daemon);
    void lose(RobotDaemons::Daemon *daemon);
    Feed &feedOf(RobotDaemons::Daemon *daemon, const QString &topic);
    Outlet *outletFor(const ros::Mapping &mapping, const QString &daemon);
    void readersChanged(Outlet &outlet);
    void subscribeAsWanted(Feed &feed);
    void take(Feed &feed, const TopicUpdate &update);
    void write(Outlet &outlet);
    void tellTime(double stamp);
    void refresh();
    void tellGraph();

    const Options options_;
    RobotDaemons &daemons_;
    std::unique_ptr<Participant> participant_;
    NodeGraph graph_;
    ros::RobotModel robot_;
    std::deque<Outlet> outlets_; // they stay where they are, as do the feeds
    std::deque<Feed> feeds_;
    struct Newcomer {
        RobotDaemons::Daemon *daemon;
        double since; ///< of monotonicNow()
    };
    std::deque<Newcomer> newcomers_;                 ///< that have no topics yet
    std::vector<Guid> readers_, writers_;            ///< of others
    std::map<RobotDaemons::Daemon *, int> settings_; ///< handles of the subscriptions
    std::unique_ptr<Writer> clock_;                  ///< of replays
    double toldTime_ = 0;                            ///< its last stamp
    std::string cdr_;
    Counts counts_;
    QTimer second_;
};

} // namespace hermes::ros2
