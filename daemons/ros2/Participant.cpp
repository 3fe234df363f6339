#include "daemons/ros2/Participant.h"

#include "common/Log.h"
#include "common/Time.h"
#include "daemons/ros2/RawType.h"
#include "daemons/ros2/SocketGuard.h"
#include "protocol/ros/Definition.h"

#include <QFileInfo>
#include <QRegularExpression>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#pragma GCC diagnostic pop

namespace hermes::ros2 {
namespace {

constexpr int maxKept = 1000;        // samples, where all are
constexpr int maxTaken = 32;         // at a time
constexpr double logPause_s = 10;    // between two lines of Cyclone
constexpr int socketBytes = 4 << 20; // of received data; the system may give less

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t *)>;
using Listener = std::unique_ptr<dds_listener_t, void (*)(dds_listener_t *)>;

Qos qosOf(const Quality &quality, const QByteArray &userData) {
    Qos qos(dds_create_qos(), dds_delete_qos);
    dds_qset_reliability(qos.get(),
                         quality.isReliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos.get(),
                        quality.isLatched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    if (quality.depth > 0) {
        dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
    } else {
        dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
        dds_qset_resource_limits(qos.get(), maxKept, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    }
    if (quality.isLatched) // what latecomers get is what is kept
        dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, std::max(1, quality.depth), maxKept,
                                    DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    if (quality.lifespan_s > 0)
        dds_qset_lifespan(qos.get(), dds_duration_t(quality.lifespan_s * 1e9));
    dds_qset_writer_data_lifecycle(qos.get(), false); // as ROS has it
    if (!userData.isEmpty())
        dds_qset_userdata(qos.get(), userData.data(), std::size_t(userData.size()));
    return qos;
}

Error failure(const QString &what, int code) {
    return Error(ErrorCode::DeviceFault, QString("%1: %2").arg(what, dds_strretcode(code)));
}

Guid guidOf(int entity) {
    dds_guid_t guid{};
    dds_get_guid(entity, &guid);
    Guid made{};
    std::copy(std::begin(guid.v), std::end(guid.v), made.begin());
    return made;
}

/// The files of an enclave. Source: SROS2, as rmw_cyclonedds reads them.
Result<void> secure(dds_qos_t *qos, const QString &folder) {
    const std::pair<const char *, const char *> files[] = {
        {"dds.sec.auth.identity_ca", "identity_ca.cert.pem"},
        {"dds.sec.auth.private_key", "key.pem"},
        {"dds.sec.auth.identity_certificate", "cert.pem"},
        {"dds.sec.access.permissions_ca", "permissions_ca.cert.pem"},
        {"dds.sec.access.governance", "governance.p7s"},
        {"dds.sec.access.permissions", "permissions.p7s"}};
    for (const auto &[property, name] : files) {
        const QFileInfo file(folder + '/' + name);
        if (!file.isReadable())
            return Error(ErrorCode::InputOutput,
                         file.absoluteFilePath() + ": cannot be read, expected a file of an enclave");
        dds_qset_prop(qos, property, ("file:" + QFile::encodeName(file.absoluteFilePath())).constData());
    }
    const std::array<const char *, 3> plugins[] = {{"auth", "dds_security_auth", "authentication"},
                                                   {"crypto", "dds_security_crypto", "crypto"},
                                                   {"access", "dds_security_ac", "access_control"}};
    for (const auto &[name, library, function] : plugins) {
        const std::string prefix = std::string("dds.sec.") + name + ".library.";
        const std::string end = std::string("_") + function;
        dds_qset_prop(qos, (prefix + "path").c_str(), library);
        dds_qset_prop(qos, (prefix + "init").c_str(), ("init" + end).c_str());
        dds_qset_prop(qos, (prefix + "finalize").c_str(), ("finalize" + end).c_str());
    }
    return {};
}

/// A damaged datagram gives a line each: so no more than one now and then is told, with the number of the
/// others.
void logCyclone(void *, const dds_log_data_t *line) {
    static std::atomic<double> last{-logPause_s};
    static std::atomic<int> others{0};
    const QString text = QString::fromUtf8(line->message, int(line->size)).trimmed();
    if (text.contains("is not multicast-capable")) // the loopback is none, nor need it be
        return;
    const double now = monotonicNow();
    double before = last;
    if (now - before < logPause_s || !last.compare_exchange_strong(before, now)) {
        ++others;
        return;
    }
    const int missing = others.exchange(0);
    logWarning("dds", missing == 0 ? text : QString("%1 (and %2 lines before)").arg(text).arg(missing));
}

} // namespace

Result<QString> configurationOf(const ParticipantOptions &options) {
    static const QRegularExpression host("^[A-Za-z0-9][A-Za-z0-9._:-]{0,100}$");
    static const QRegularExpression address("^[0-9.]+$|:");
    QString interfaces, peers;
    const QStringList networks = options.networks.isEmpty() ? QStringList("127.0.0.1") : options.networks;
    for (const QString &one : networks) {
        if (!host.match(one).hasMatch())
            return Error(ErrorCode::InvalidParams,
                         "networks: \"" + one + "\" is neither the name nor the address of an interface");
        interfaces += QString("<NetworkInterface %1=\"%2\"/>")
                          .arg(address.match(one).hasMatch() ? "address" : "name", one);
    }
    QStringList asked = options.peers;
    if (options.networks.isEmpty())
        asked.append("127.0.0.1");
    for (const QString &one : asked) {
        if (!host.match(one).hasMatch())
            return Error(ErrorCode::InvalidParams, "peers: \"" + one + "\" is no host");
        peers += QString("<Peer address=\"%1\"/>").arg(one);
    }
    return QString(
               "<CycloneDDS><Domain><General><Interfaces>%1</Interfaces><FragmentSize>%2B</FragmentSize>"
               "<MaxMessageSize>%3B</MaxMessageSize><AllowMulticast>%6</AllowMulticast></General><Discovery>"
               "<ParticipantIndex>auto</ParticipantIndex>"
               "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><SPDPInterval>1s</SPDPInterval>"
               "<Peers>%4</Peers></Discovery><Internal><SocketReceiveBufferSize max=\"%5B\"/></Internal>"
               "</Domain></CycloneDDS>")
        .arg(interfaces)
        .arg(options.fragmentBytes)
        .arg(std::max(options.fragmentBytes + 2500, 14720))
        .arg(peers)
        .arg(socketBytes)
        .arg(options.networks.isEmpty() ? "false" : "default");
}

Result<std::unique_ptr<Participant>> Participant::open(const ParticipantOptions &options) {
    const Result<QString> configuration = configurationOf(options);
    if (!configuration)
        return configuration.error();
    dds_set_log_sink(logCyclone, nullptr);
    dds_set_trace_sink(logCyclone, nullptr);
    std::unique_ptr<Participant> made(new Participant);
    const SocketGuard guard(options.networks);
    if (const Result<void> known = guard.check(); !known)
        return known.error();
    const QString what = QString("the DDS domain %1").arg(options.domain);
    made->domain_ = dds_create_domain(dds_domainid_t(options.domain), configuration->toUtf8().constData());
    if (made->domain_ < 0)
        return failure(what + " cannot be opened", made->domain_);
    const QString enclave = options.enclave.isEmpty() ? QString() : QFileInfo(options.enclave).fileName();
    const Qos qos = qosOf({}, "enclave=/" + enclave.toUtf8() + ';');
    if (!enclave.isEmpty())
        if (const Result<void> secured = secure(qos.get(), options.enclave); !secured)
            return secured.error();
    made->entity_ = dds_create_participant(dds_domainid_t(options.domain), qos.get(), nullptr);
    if (made->entity_ < 0)
        return failure(what + " cannot be joined", made->entity_);
    made->guid_ = guidOf(made->entity_);
    if (const Result<void> guarded = guard.guardNewSockets(); !guarded) // nobody is read as yet
        return guarded.error();
    return made;
}

Participant::~Participant() {
    if (domain_ > 0)
        dds_delete(domain_); // and all that is in it
}

Result<int> Participant::topic(const QString &name, const std::string &type, ddsi_sertype *&made) {
    made = newRawType(ros::ddsType(type));
    const Qos qos = qosOf({}, {});
    return int(
        dds_create_topic_sertype(entity_, name.toUtf8().constData(), &made, qos.get(), nullptr, nullptr));
}

Result<std::unique_ptr<Writer>> Participant::write(const QString &name, const std::string &type,
                                                   const Quality &quality, const QByteArray &userData,
                                                   std::function<void()> matched) {
    std::unique_ptr<Writer> made(new Writer);
    ddsi_sertype *sertype = nullptr;
    made->topic_ = *topic(name, type, sertype);
    if (made->topic_ < 0)
        return failure("the topic " + name, made->topic_);
    made->type_ = sertype;
    made->context_ = &context_;
    made->matched_ = std::move(matched);
    const Listener listener(dds_create_listener(made.get()), dds_delete_listener);
    dds_lset_publication_matched(
        listener.get(), [](dds_entity_t, const dds_publication_matched_status_t status, void *argument) {
            auto *const writer = static_cast<Writer *>(argument);
            writer->readers_ = int(status.current_count);
            if (writer->matched_)
                QMetaObject::invokeMethod(writer->context_, writer->matched_, Qt::QueuedConnection);
        });
    const Qos qos = qosOf(quality, userData);
    made->entity_ = dds_create_writer(entity_, made->topic_, qos.get(), listener.get());
    if (made->entity_ < 0)
        return failure("a writer of " + name, made->entity_);
    made->guid_ = guidOf(made->entity_);
    return made;
}

Result<std::unique_ptr<Reader>> Participant::read(const QString &name, const std::string &type,
                                                  const Quality &quality, Reader::Callback callback,
                                                  const QByteArray &userData) {
    std::unique_ptr<Reader> made(new Reader);
    ddsi_sertype *sertype = nullptr;
    made->topic_ = *topic(name, type, sertype);
    if (made->topic_ < 0)
        return failure("the topic " + name, made->topic_);
    made->context_ = std::make_unique<QObject>();
    made->callback_ = std::move(callback);
    const Listener listener(dds_create_listener(made.get()), dds_delete_listener);
    dds_lset_data_available(listener.get(), [](dds_entity_t, void *argument) {
        auto *const reader = static_cast<Reader *>(argument);
        if (!reader->isCalled_.exchange(true)) // one call takes all that came meanwhile
            QMetaObject::invokeMethod(
                reader->context_.get(), [reader] { reader->take(); }, Qt::QueuedConnection);
    });
    const Qos qos = qosOf(quality, userData);
    made->entity_ = dds_create_reader(entity_, made->topic_, qos.get(), listener.get());
    if (made->entity_ < 0)
        return failure("a reader of " + name, made->entity_);
    made->guid_ = guidOf(made->entity_);
    return made;
}

Writer::~Writer() {
    if (entity_ > 0)
        dds_delete(entity_);
    if (topic_ > 0)
        dds_delete(topic_);
}

void Writer::write(std::string_view cdr) {
    if (const int code = dds_writecdr(entity_, newRawSample(type_, cdr)); code < 0)
        logWarning("dds", QString("a sample was not written: %1").arg(dds_strretcode(code)));
}

Reader::~Reader() {
    if (entity_ > 0)
        dds_delete(entity_); // waits for its listener
    if (topic_ > 0)
        dds_delete(topic_);
}

void Reader::take() {
    isCalled_ = false;
    ddsi_serdata *samples[maxTaken];
    dds_sample_info_t infos[maxTaken];
    for (int round = 0; round * maxTaken < maxKept; ++round) {
        const int count = dds_takecdr(entity_, samples, maxTaken, infos,
                                      DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE);
        if (count <= 0)
            return;
        for (int i = 0; i < count; ++i) {
            if (infos[i].valid_data) {
                Sample sample;
                sample.cdr = bytesOf(samples[i]);
                sample.stamp = double(infos[i].source_timestamp) * 1e-9;
                tellWriter(infos[i].publication_handle, sample);
                callback_(sample);
            }
            releaseRawSample(samples[i]);
        }
    }
}

/// Nothing where it is gone.
void Reader::tellWriter(std::uint64_t handle, Sample &sample) const {
    dds_builtintopic_endpoint_t *const endpoint = dds_get_matched_publication_data(entity_, handle);
    if (!endpoint)
        return;
    std::copy(std::begin(endpoint->key.v), std::end(endpoint->key.v), sample.writer.begin());
    void *data = nullptr;
    std::size_t size = 0;
    if (endpoint->qos && dds_qget_userdata(endpoint->qos, &data, &size) && data) {
        sample.userData = QByteArray(static_cast<const char *>(data), int(std::min<std::size_t>(size, 1000)));
        dds_free(data);
    }
    dds_builtintopic_free_endpoint(endpoint);
}

} // namespace hermes::ros2
