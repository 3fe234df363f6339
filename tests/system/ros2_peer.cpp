// Stands for any node of ROS 2 with rmw_fastrtps, on one network (the loopback interface): writes and reads
// topics of Fast DDS as bytes, known by the names of their types alone, and lists what it discovers. Requests
// and answers are lines of JSON (tests/system/ros2_support.py):
//
//   {"op": "read", "topic": "rt/scan", "type": "sensor_msgs::msg::dds_::LaserScan_", "reliable": true,
//    "transient_local": false, "depth": 5, "user_data": "", "quiet": false}   each sample is a line; quiet:
//                                                            they are counted
//   {"op": "write", ...}                                     with the same members
//   {"op": "send", "topic": ..., "hex": ..., "count": 1, "hz": 0}   count 0: until stop or close
//   {"op": "stop", "topic": ...}, {"op": "close", "topic": ...}
//   {"op": "list"}                                           what was discovered
//   {"op": "report"}                                         samples, bytes, milliseconds of each topic
//
// Bytes begin with their encapsulation. Each request is answered by {"done": op, ...} or {"error": ...}.
// It ends with its input.
#include "ros2/Discovered.h"
#include "ros2/Endpoint.h"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <map>

namespace ros2 {

namespace {

class Peer {
public:
    Peer(std::uint32_t domain, const std::string &own, const std::string &others, const std::string &keys,
         const std::string &userData, std::vector<std::string> quiet)
        : quiet_(std::move(quiet)) {
        dds::DomainParticipantQos qos;
        qos.name("ros2_peer");
        qos.user_data().data_vec(Bytes(userData.begin(), userData.end()));
        qos.transport().use_builtin_transports = false;
        auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
        transport->interfaceWhiteList = {own};
        transport->sendBufferSize = transport->receiveBufferSize = 4 << 20;
        transport->maxInitialPeersRange = 32; // participants of a host that are looked for
        qos.transport().user_transports.push_back(transport);
        rtps::Locator_t here, there;
        rtps::IPLocator::setIPv4(here, own);
        rtps::IPLocator::setIPv4(there, others);
        auto &builtin = qos.wire_protocol().builtin;
        builtin.initialPeersList.push_back(there);             // port 0: those that the domain gives
        builtin.metatrafficUnicastLocatorList.push_back(here); // and none of multicast
        builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
        if (!keys.empty())
            secure(qos.properties(), "file://" + keys + "/");
        participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
            domain, qos, &discovered_, dds::StatusMask::none());
        if (!participant_)
            throw std::runtime_error("no participant of domain " + std::to_string(domain));
        publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
        subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    }
    ~Peer() {
        while (!endpoints_.empty())
            close(endpoints_.begin()->first);
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }
    Peer(const Peer &) = delete;
    Peer &operator=(const Peer &) = delete;

    Json answer(const Json &request) {
        const std::string what = request.at("op"), topic = request.value("topic", "");
        Json done = {{"done", what}, {"topic", topic}};
        if (what == "read")
            read(topic, request);
        else if (what == "write")
            write(topic, request);
        else if (what == "send")
            send(of(topic), request);
        else if (what == "stop")
            of(topic).sender.reset();
        else if (what == "close")
            close(topic);
        else if (what == "list")
            done.update(discovered_.list(guid()));
        else if (what == "report")
            for (const auto &[name, endpoint] : endpoints_) {
                if (endpoint.samples)
                    done["topics"][name] = endpoint.samples->report();
            }
        else
            throw std::runtime_error("op: expected read, write, send, stop, close, list or report");
        return done;
    }
    std::string guid() const { return hexOf(participant_->guid()); }

private:
    const std::vector<std::string> quiet_;
    Discovered discovered_;
    dds::DomainParticipant *participant_ = nullptr;
    dds::Publisher *publisher_ = nullptr;
    dds::Subscriber *subscriber_ = nullptr;
    std::map<std::string, Endpoint> endpoints_; // by topic

    /// With the files of an enclave of SROS2.
    static void secure(rtps::PropertyPolicy &policy, const std::string &folder) {
        const std::string authentication = "dds.sec.auth.builtin.PKI-DH.",
                          access = "dds.sec.access.builtin.Access-Permissions.";
        for (const auto &[name, value] : std::map<std::string, std::string>{
                 {"dds.sec.auth.plugin", "builtin.PKI-DH"},
                 {"dds.sec.access.plugin", "builtin.Access-Permissions"},
                 {"dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC"},
                 {authentication + "identity_ca", folder + "identity_ca.cert.pem"},
                 {authentication + "identity_certificate", folder + "cert.pem"},
                 {authentication + "private_key", folder + "key.pem"},
                 {access + "permissions_ca", folder + "permissions_ca.cert.pem"},
                 {access + "governance", folder + "governance.p7s"},
                 {access + "permissions", folder + "permissions.p7s"}})
            policy.properties().emplace_back(name, value);
    }
    Endpoint &of(const std::string &topic) {
        const auto found = endpoints_.find(topic);
        if (found == endpoints_.end())
            throw std::runtime_error("topic: \"" + topic + "\" is neither read nor written");
        return found->second;
    }
    Endpoint &on(const std::string &topic, const std::string &type) {
        Endpoint &endpoint = endpoints_[topic];
        if (endpoint.topic && endpoint.topic->get_type_name() != type)
            throw std::runtime_error("type: \"" + topic + "\" has another one here");
        if (!endpoint.topic) {
            dds::TypeSupport(new RawType(type)).register_type(participant_);
            endpoint.topic = participant_->create_topic(topic, type, dds::TOPIC_QOS_DEFAULT);
        }
        if (!endpoint.topic) {
            endpoints_.erase(topic);
            throw std::runtime_error("topic: \"" + topic + "\" was not created");
        }
        return endpoint;
    }
    void read(const std::string &topic, const Json &request) {
        Endpoint &endpoint = on(topic, request.at("type"));
        if (endpoint.reader)
            throw std::runtime_error("topic: \"" + topic + "\" is read already");
        const bool isQuiet = request.value("quiet", false) || std::count(quiet_.begin(), quiet_.end(), topic);
        endpoint.samples = std::make_unique<Samples>(topic, isQuiet);
        endpoint.reader = subscriber_->create_datareader(
            endpoint.topic, qosOf(request, dds::DATAREADER_QOS_DEFAULT), endpoint.samples.get());
        if (!endpoint.reader)
            throw std::runtime_error("topic: no reader of \"" + topic + "\" was created");
    }
    void write(const std::string &topic, const Json &request) {
        Endpoint &endpoint = on(topic, request.at("type"));
        if (endpoint.writer)
            throw std::runtime_error("topic: \"" + topic + "\" is written already");
        dds::DataWriterQos qos = qosOf(request, dds::DATAWRITER_QOS_DEFAULT);
        qos.writer_data_lifecycle().autodispose_unregistered_instances = false;
        endpoint.matches = std::make_unique<Matches>(topic);
        endpoint.writer = publisher_->create_datawriter(endpoint.topic, qos, endpoint.matches.get());
        if (!endpoint.writer)
            throw std::runtime_error("topic: no writer of \"" + topic + "\" was created");
    }
    static void send(Endpoint &endpoint, const Json &request) {
        if (!endpoint.writer)
            throw std::runtime_error("topic: it is not written");
        endpoint.sender.reset(); // before it begins anew
        Bytes bytes = bytesOf(request.at("hex"));
        const std::uint64_t count = request.value("count", 1u);
        if (count != 1)
            endpoint.sender =
                std::make_unique<Sender>(endpoint.writer, std::move(bytes), count, request.value("hz", 0.0));
        else if (!endpoint.writer->write(&bytes))
            throw std::runtime_error("topic: the sample was not written");
    }
    void close(const std::string &topic) {
        Endpoint &endpoint = of(topic);
        endpoint.sender.reset();
        if (endpoint.writer)
            publisher_->delete_datawriter(endpoint.writer);
        if (endpoint.reader)
            subscriber_->delete_datareader(endpoint.reader);
        participant_->delete_topic(endpoint.topic);
        endpoints_.erase(topic);
    }
};

} // namespace

/// Until the end of the input.
static int run(const std::vector<std::string> &arguments) {
    std::map<std::string, std::string> options = {{"--domain", "0"},
                                                  {"--own", "127.0.0.1"},
                                                  {"--others", "127.0.0.1"},
                                                  {"--keys", ""},
                                                  {"--user-data", "enclave=/;"}};
    std::vector<std::string> quiet;
    for (std::size_t i = 0; i < arguments.size(); i += 2) {
        if (i + 1 == arguments.size())
            throw std::runtime_error(arguments[i] + ": a value is missing");
        if (arguments[i] == "--quiet")
            quiet.push_back(arguments[i + 1]);
        else if (options.count(arguments[i]))
            options[arguments[i]] = arguments[i + 1];
        else
            throw std::runtime_error(
                "expected --domain N, --own ADDRESS, --others ADDRESS, --keys FOLDER, --user-data TEXT or "
                "--quiet TOPIC, found " +
                arguments[i]);
    }
    auto log = std::make_unique<dds::StdoutErrConsumer>(); // standard output is for the answers
    log->stderr_threshold(dds::Log::Kind::Info);
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::move(log));
    Peer peer(std::uint32_t(std::stoul(options["--domain"])), options["--own"], options["--others"],
              options["--keys"], options["--user-data"], quiet);
    tell({{"ready", peer.guid()}});
    for (std::string line; std::getline(std::cin, line);) {
        try {
            tell(peer.answer(Json::parse(line)));
        } catch (const std::exception &error) {
            tell({{"error", error.what()}, {"line", line.substr(0, 200)}});
        }
    }
    return 0;
}

} // namespace ros2

int main(int argc, char **argv) {
    try {
        return ros2::run({argv + 1, argv + argc});
    } catch (const std::exception &error) {
        std::cerr << "ros2_peer: " << error.what() << '\n';
        return 2;
    }
}
