#include "daemons/web/WebClient.h"

#include "common/Time.h"
#include "protocol/wire/JsonText.h"

#include <QWebSocket>
#include <cmath>

namespace hermes::web {
namespace {

constexpr int maxEntries = 1000; // of a list in one operation, and of what a client may hold
constexpr int maxCalls = 32;     // of services, that wait
constexpr double dropPeriod_s = 2.5;
constexpr double afterGap_s = 0.1; // what comes so soon after this program stood still was sent while it did

/// Nothing: it is none from 0 to 2^32 - 1.
std::optional<quint32> idIn(const QJsonValue &value) {
    const double number = value.toDouble(-1);
    const bool isId = number >= 0 && number <= 4294967295.0 && number == std::floor(number);
    return isId ? std::optional(quint32(number)) : std::nullopt;
}

std::optional<QJsonObject> objectIn(const QByteArray &json, QString &why) {
    WireError error;
    const auto read = WireValue::parse(json, &error, {30, 100000});
    if (!read || read->kind() != WireView::Kind::Object) {
        why = read ? "expected an object of JSON" : "no JSON: " + error.message;
        return {};
    }
    return read->toJson().toObject();
}

QJsonArray entriesOf(const QJsonObject &operation, const char *list) {
    QJsonArray entries = operation[QLatin1String(list)].toArray();
    while (entries.size() > maxEntries)
        entries.removeLast();
    return entries;
}

} // namespace

WebClient::WebClient(QWebSocket *socket, Role role, Hall &hall, QObject *parent)
    : QObject(parent)
    , socket_(socket)
    , role_(role)
    , hall_(hall)
    , name_(QString("web %1:%2").arg(socket->peerAddress().toString()).arg(socket->peerPort())) {
    socket_->setParent(this);
    socket_->setMaxAllowedIncomingFrameSize(maxFrame);
    socket_->setMaxAllowedIncomingMessageSize(maxFrame);
    connect(socket_, &QWebSocket::textMessageReceived, this, &WebClient::takeText);
    connect(socket_, &QWebSocket::binaryMessageReceived, this, &WebClient::takeBinary);
    connect(socket_, &QWebSocket::pong, this, [this] { isAlive_ = true; });
    connect(socket_, &QWebSocket::disconnected, this, &WebClient::gone);
    RobotView &robot = hall_.robot;
    connect(&robot, &RobotView::message, this, &WebClient::sendMessage);
    connect(&robot, &RobotView::changed, this, &WebClient::advertiseAll);
    connect(&robot, &RobotView::parametersChanged, this, &WebClient::onParameters);
    greet();
}

WebClient::~WebClient() {
    socket_->disconnect(this);
    for (auto one = subscriptions_.begin(); one != subscriptions_.end(); ++one)
        hall_.robot.unsubscribe(one.key());
}

void WebClient::greet() {
    QJsonArray capabilities{"parameters", "parametersSubscribe", "services"};
    if (role_ >= Role::Operator)
        capabilities.append("clientPublish");
    send({{"op", "serverInfo"},
          {"name", hall_.name},
          {"capabilities", capabilities},
          {"supportedEncodings", QJsonArray{"json"}},
          {"metadata", QJsonObject{{"role", toString(role_)}}},
          {"sessionId", hall_.session}});
    advertiseAll();
}

void WebClient::advertiseAll() {
    tellChanges(channels_, hall_.robot.channels(role_),
                {"advertise", "channels", "unadvertise", "channelIds"});
    tellChanges(services_, hall_.robot.services(role_),
                {"advertiseServices", "services", "unadvertiseServices", "serviceIds"});
    for (const quint32 channel : subscriptions_.keys())
        if (!channels_->contains(channel))
            subscriptions_.remove(channel);
}

/// words: the operation that tells new ones and its list, that which tells those that are gone and its list.
void WebClient::tellChanges(std::optional<QSet<quint32>> &told, const QJsonArray &now,
                            const std::array<QString, 4> &words) {
    QSet<quint32> ids;
    QJsonArray fresh, gone;
    for (const QJsonValue &one : now) {
        const auto id = quint32(one["id"].toDouble());
        ids.insert(id);
        if (!told || !told->contains(id))
            fresh.append(one);
    }
    for (const quint32 id : told.value_or(QSet<quint32>()))
        if (!ids.contains(id))
            gone.append(double(id));
    if (!gone.isEmpty())
        send({{"op", words[2]}, {words[3], gone}});
    if (!fresh.isEmpty() || !told) // the first list may be empty
        send({{"op", words[0]}, {words[1], fresh}});
    told = ids;
}

void WebClient::checkAlive() {
    if (!std::exchange(isAlive_, false))
        return socket_->abort();
    socket_->ping();
}

const QHash<QString, WebClient::Operation> &WebClient::operations() {
    static const QHash<QString, Operation> all{
        {"subscribe", &WebClient::subscribe},
        {"unsubscribe", &WebClient::unsubscribe},
        {"advertise", &WebClient::advertise},
        {"unadvertise", &WebClient::unadvertise},
        {"getParameters", &WebClient::getParameters},
        {"setParameters", &WebClient::setParameters},
        {"subscribeParameterUpdates", &WebClient::watchParameters},
        {"unsubscribeParameterUpdates", &WebClient::unwatchParameters},
    };
    return all;
}

void WebClient::takeText(const QString &text) {
    isAlive_ = true;
    QString why;
    const auto operation = objectIn(text.toUtf8(), why);
    const QString name = operation ? (*operation)["op"].toString() : QString();
    if (const Operation known = operations().value(name))
        return (this->*known)(*operation);
    ++hall_.bad;
    tell(Level::Error, operation ? QString("unknown operation \"%1\"").arg(name.left(50)) : why);
}

void WebClient::takeBinary(const QByteArray &bytes) {
    isAlive_ = true;
    const ClientFrame frame = ClientFrame::parse(bytes);
    if (frame.kind == ClientFrame::Kind::Message)
        return steer(frame.id, frame.content);
    if (frame.kind == ClientFrame::Kind::Call)
        return request(frame);
    ++hall_.bad;
    tell(Level::Error, QString("a binary frame of %1 bytes is none that is known").arg(bytes.size()));
}

void WebClient::subscribe(const QJsonObject &operation) {
    for (const QJsonValue &entry : entriesOf(operation, "subscriptions")) {
        const auto id = idIn(entry["id"]), channel = idIn(entry["channelId"]);
        const QString shown = compactJson(entry).left(100);
        if (!id || !channel || !hall_.robot.has(*channel, role_))
            tell(Level::Warning, "no such channel: " + shown);
        else if (subscriptions_.contains(*channel))
            tell(Level::Warning, "this channel is subscribed to already: " + shown);
        else if (subscriptions_.size() >= maxEntries || subscriptions_.values().contains(*id))
            tell(Level::Error, "this id is in use, or there are too many subscriptions: " + shown);
        else {
            subscriptions_[*channel] = *id;
            hall_.robot.subscribe(*channel);
        }
    }
}

void WebClient::unsubscribe(const QJsonObject &operation) {
    for (const QJsonValue &entry : entriesOf(operation, "subscriptionIds")) {
        const auto id = idIn(entry);
        const auto channels = id ? subscriptions_.keys(*id) : QList<quint32>();
        if (channels.isEmpty())
            tell(Level::Warning, "no such subscription: " + compactJson(entry).left(100));
        for (const quint32 channel : channels) {
            subscriptions_.remove(channel);
            hall_.robot.unsubscribe(channel);
        }
    }
}

void WebClient::sendMessage(quint32 channel, double stamp, const QByteArray &json) {
    const auto subscription = subscriptions_.constFind(channel);
    if (subscription == subscriptions_.constEnd())
        return;
    if (socket_->bytesToWrite() + json.size() > maxUnsent) {
        ++hall_.dropped;
        if (monotonicNow() - dropTold_ > dropPeriod_s) {
            dropTold_ = monotonicNow();
            tell(Level::Warning, "Send buffer limit reached: messages were dropped", "dropped");
        }
        return;
    }
    socket_->sendBinaryMessage(messageFrame(*subscription, stamp, json));
}

void WebClient::getParameters(const QJsonObject &operation) {
    sendParameters(operation["parameterNames"].toVariant().toStringList(), operation["id"]);
}

void WebClient::setParameters(const QJsonObject &operation) {
    const QJsonArray parameters = entriesOf(operation, "parameters");
    QStringList names;
    for (const QJsonValue &parameter : parameters)
        names.append(parameter["name"].toString());
    const auto done = [this, alive = QPointer<WebClient>(this), names,
                       id = operation["id"]](const QString &refusals) {
        if (!alive)
            return;
        --calls_;
        if (!refusals.isEmpty())
            tell(Level::Error, refusals);
        if (!names.isEmpty())
            sendParameters(names, id);
    };
    ++calls_;
    if (role_ < Role::Engineer)
        return done("settings are for the role engineer; web clients have " + toString(role_));
    if (calls_ > maxCalls)
        return done("too many requests wait for their answers already");
    hall_.robot.setParameters(parameters, done);
}

void WebClient::sendParameters(const QStringList &names, const QJsonValue &id) {
    QJsonObject answer{{"op", "parameterValues"}, {"parameters", hall_.robot.parameters(names)}};
    if (id.isString())
        answer["id"] = id;
    send(answer);
}

void WebClient::watchParameters(const QJsonObject &operation) {
    for (const QJsonValue &name : entriesOf(operation, "parameterNames"))
        if (watched_.size() < 10 * maxEntries)
            watched_.insert(name.toString().left(200));
}

void WebClient::unwatchParameters(const QJsonObject &operation) {
    for (const QJsonValue &name : entriesOf(operation, "parameterNames"))
        watched_.remove(name.toString());
}

void WebClient::onParameters(const QStringList &names) {
    QStringList wanted;
    for (const QString &name : names)
        if (watched_.contains(name))
            wanted.append(name);
    if (!wanted.isEmpty())
        sendParameters(wanted, {});
}

void WebClient::advertise(const QJsonObject &operation) {
    for (const QJsonValue &entry : entriesOf(operation, "channels")) {
        const auto id = idIn(entry["id"]);
        const bool isTwist = entry["encoding"] == "json" &&
                             QStringList{"geometry_msgs/Twist", "geometry_msgs/msg/Twist"}.contains(
                                 entry["schemaName"].toString());
        if (role_ < Role::Operator)
            tell(Level::Error, "to drive is for the role operator; web clients have " + toString(role_));
        else if (!id || !isTwist || steering_.size() >= maxEntries)
            tell(Level::Warning, "only geometry_msgs/Twist as json is of use here, not " +
                                     QString::fromUtf8(compactJson(entry)).left(100));
        else
            steering_.insert(*id);
    }
}

void WebClient::unadvertise(const QJsonObject &operation) {
    for (const QJsonValue &entry : entriesOf(operation, "channelIds"))
        if (const auto id = idIn(entry))
            steering_.remove(*id);
    if (steering_.isEmpty())
        teleop_.reset();
}

void WebClient::steer(quint32 channel, const QByteArray &json) {
    QString why = "the channel was not advertised as one of geometry_msgs/Twist";
    const auto twist = steering_.contains(channel) ? objectIn(json, why) : std::nullopt;
    if (!twist) {
        ++hall_.bad;
        return tell(Level::Error, "cannot drive: " + why);
    }
    hall_.gaps.look();
    if (hall_.gaps.sinceLast() < afterGap_s)
        return;
    if (const QString motors = hall_.robot.motors(); !teleop_ || teleop_->address() != motors)
        teleop_ = std::make_unique<Teleop>(
            hall_.robot.motors(), name_, hall_.deadMan_s,
            [this](const QString &message) { tell(Level::Warning, message, "drive"); });
    teleop_->steer({(*twist)["linear"]["x"].toDouble(), (*twist)["linear"]["y"].toDouble(),
                    (*twist)["angular"]["z"].toDouble()});
}

QString WebClient::objection(const Service &service, const QJsonObject &params) const {
    if (role_ < service.role)
        return QString("%1 is for the role %2; web clients have %3")
            .arg(service.method, toString(service.role), toString(role_));
    if (service.isUrgent)
        return {};
    for (auto one = service.restricted.begin(); one != service.restricted.end(); ++one)
        if (params.contains(one.key()) && role_ < roleFrom(one->toString()).value_or(Role::Engineer))
            return QString("%1 is for the role %2").arg(one.key(), one->toString());
    if (service.takesConfirm && !params["confirm"].toBool()) // all web clients are one to the daemon
        return service.method + ": from the web only with confirm: true";
    return calls_ >= maxCalls ? "too many calls wait for their answers already" : QString();
}

void WebClient::request(const ClientFrame &frame) {
    const Service *const service = hall_.robot.service(frame.id);
    if (frame.encoding != "json" || !service)
        return send({{"op", "serviceCallFailure"},
                     {"serviceId", double(frame.id)},
                     {"callId", double(frame.call)},
                     {"message", service ? "the encoding is not json" : "no such service"}});
    QString why;
    std::optional<QJsonObject> params = QJsonObject();
    if (!frame.content.isEmpty())
        params = objectIn(frame.content, why);
    if (!params && service->isUrgent) { // a stop is never refused for its form
        params = QJsonObject();
        why.clear();
    }
    if (params)
        why = objection(*service, *params);
    if (!why.isEmpty())
        return answer(frame.id, frame.call, Error(ErrorCode::NotAuthorised, why));
    if (service->takesClient && !params->contains("client"))
        params->insert("client", name_);
    ++calls_;
    hall_.robot.call(*service, *params,
                     [this, alive = QPointer<WebClient>(this), id = frame.id,
                      call = frame.call](const Result<QJsonValue> &result) {
                         if (!alive)
                             return;
                         --calls_;
                         answer(id, call, result);
                     });
}

/// A refusal is an answer, too: Lichtblick takes no notice of serviceCallFailure.
void WebClient::answer(quint32 service, quint32 call, const Result<QJsonValue> &result) {
    const QJsonObject json =
        result ? QJsonObject{{"ok", true}, {"result", *result}}
               : QJsonObject{{"ok", false}, {"error", result.error().message}, {"code", result.error().code}};
    if (!isFull())
        socket_->sendBinaryMessage(answerFrame(service, call, compactJson(json)));
}

/// Of who asks much and reads nothing.
bool WebClient::isFull() {
    if (socket_->bytesToWrite() <= mostUnsent)
        return false;
    QMetaObject::invokeMethod(
        socket_, [socket = socket_] { socket->abort(); }, Qt::QueuedConnection);
    return true;
}

void WebClient::send(const QJsonObject &operation) {
    if (!isFull())
        socket_->sendTextMessage(QString::fromUtf8(compactJson(operation)));
}

void WebClient::tell(Level level, const QString &message, const QString &id) {
    QJsonObject status{{"op", "status"}, {"level", int(level)}, {"message", message}};
    if (!id.isEmpty())
        status["id"] = id;
    send(status);
}

} // namespace hermes::web
