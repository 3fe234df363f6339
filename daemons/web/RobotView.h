#pragma once

#include "common/Role.h"
#include "common/daemon/RobotDaemons.h"
#include "daemons/web/Views.h"

#include <QJsonArray>

namespace hermes::web {

/// A command of a daemon as web clients see it.
struct Service {
    quint32 id = 0;
    QString daemon, method;
    Role role = Role::Engineer;
    bool isUrgent = false, takesClient = false, takesConfirm = false;
    QJsonObject restricted; ///< parameters that need more rights: their roles
    QJsonObject told;       ///< as advertiseServices has it
};

/// The robot as web clients see it: channels, services and parameters of all its daemons. A topic is
/// subscribed to while a web client is subscribed to a channel of it.
class RobotView : public QObject {
    Q_OBJECT
public:
    explicit RobotView(const QString &robot);
    ~RobotView() override;

    RobotDaemons &daemons() { return daemons_; }

    /// Of all channels that this role may see, as `advertise` has them.
    QJsonArray channels(Role role) const;
    bool has(quint32 channel, Role role) const;
    /// To a channel that is there.
    void subscribe(quint32 channel);
    void unsubscribe(quint32 channel);

    QJsonArray services(Role role) const;
    const Service *service(quint32 id) const;
    void call(const Service &service, const QJsonObject &params, const Client::Callback &done);

    /// Settings in force, as `parameterValues` has them: those of these names, "DAEMON.PATH"; none: all.
    QJsonArray parameters(const QStringList &names) const;
    /// Changes settings, resets those without a value; done gets what was refused, or an empty text.
    void setParameters(const QJsonArray &parameters, const std::function<void(const QString &)> &done);

    /// Of who can be driven: its address. Empty: nobody is there.
    QString motors() const;
    /// What is wrong with what comes; for people.
    QStringList problems() const;

Q_SIGNALS:
    /// Other channels or services are there.
    void changed();
    void message(quint32 channel, double stamp, const QByteArray &json);
    void parametersChanged(const QStringList &names);

private:
    struct Topic;
    struct Channel {
        QJsonObject told; ///< as `advertise` has it
        Role role = Role::Observer;
        std::unique_ptr<View> view;
        std::vector<Topic *> topics;
        int subscribers = 0;
        quint64 unreadable = 0;
        QString problem;
    };
    struct Topic {
        RobotDaemons::Daemon *daemon;
        TopicDescription description;
        std::vector<quint32> channels;
        int users = 0;  ///< channels that need it
        int handle = 0; ///< of the subscription
        quint64 dropped = 0;
        bool isRenewed = false; ///< it is to be subscribed to anew: somebody wants the full state
    };

    void come(RobotDaemons::Daemon *daemon);
    void go(RobotDaemons::Daemon *daemon);
    void addTopic(RobotDaemons::Daemon *daemon, const TopicDescription &description);
    quint32 addChannel(const QString &name, const QString &schemaName, const QJsonObject &schema,
                       std::unique_ptr<View> view);
    quint32 idOf(const QJsonObject &told);
    void join(quint32 channel, Topic *topic);
    void lookAround();
    void addService(RobotDaemons::Daemon *daemon, const QJsonObject &method);
    void use(Topic &topic);
    void begin(Topic &topic);
    void release(Topic &topic);
    void take(Topic &topic, const TopicUpdate &update);
    void send(quint32 id, double stamp, const QByteArray &json);
    void readSettings(const QString &daemon, const std::function<void()> &done);
    void takeSettings(RobotDaemons::Daemon *daemon, const QJsonObject &values);

    RobotDaemons daemons_;
    FrameTree frames_;
    QTimer due_;
    std::map<quint32, Channel> channels_;
    std::vector<std::unique_ptr<Topic>> topics_;
    std::map<quint32, Service> services_;
    std::map<RobotDaemons::Daemon *, int> settingsHandles_;
    QMap<QString, QJsonValue> parameters_; ///< by name
    QHash<QByteArray, quint32> ids_;       ///< of what was told before: it has the same id again
};

} // namespace hermes::web
