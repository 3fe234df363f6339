#pragma once

#include "daemons/ros2/Bridge.h"
#include "protocol/ros/Services.h"

#include <QCryptographicHash>

namespace hermes::ros2 {

/// A service of ROS 2 as rmw_cyclonedds calls it: number and client stand before a request and its reply.
/// Others put them elsewhere; a request of these is dropped, as it cannot be told apart from one by its
/// bytes.
template <typename Request, typename Response>
class Service {
public:
    using Answer = std::function<void(const Response &response)>;
    using Serve = std::function<void(const Request &request, const Answer &answer)>;

    /// name: "stop". type: "std_srvs/srv/Trigger". serve calls answer once, now or later.
    static Result<std::unique_ptr<Service>> open(Bridge &bridge, const QString &name, const Serve &serve) {
        std::unique_ptr<Service> made(new Service);
        made->serve_ = serve;
        const QByteArray id = "serviceid=" + idOf(bridge.participant().guid(), name) + ';';
        const QString base = bridge.space() + '/' + name;
        auto writer = bridge.participant().write("rr" + base + "Reply", ros::typeOf<Response>(), quality, id);
        if (!writer)
            return writer.error();
        made->writer_ = writer.take();
        auto reader = bridge.participant().read(
            "rq" + base + "Request", ros::typeOf<Request>(), quality,
            [service = made.get()](const Reader::Sample &sample) { service->take(sample); }, id);
        if (!reader)
            return reader.error();
        made->reader_ = reader.take();
        bridge.addEndpoints({made->reader_->guid()}, {made->writer_->guid()});
        return made;
    }

private:
    static constexpr Quality quality{true, false, 10, 0};

    Service() = default;

    /// Sixteen numbers with dots, alike for both endpoints, and for no others.
    static QByteArray idOf(const Guid &participant, const QString &name) {
        const QByteArray whole =
            QByteArray(reinterpret_cast<const char *>(participant.data()), int(participant.size())) +
            name.toUtf8();
        return QCryptographicHash::hash(whole, QCryptographicHash::Md5).toHex('.');
    }

    void take(const Reader::Sample &sample) {
        const auto request = ros::fromCdr<ros::Numbered<Request>>(sample.cdr);
        if (!sample.userData.contains("clientid=") || !request)
            return;
        serve_(request->body, [this, alive = std::weak_ptr<int>(alive_), client = request->client,
                               number = request->number](const Response &response) {
            if (alive.lock())
                writer_->write(ros::toCdr(ros::Numbered<Response>{client, number, response}));
        });
    }

    Serve serve_;
    std::unique_ptr<Writer> writer_;
    std::unique_ptr<Reader> reader_;
    std::shared_ptr<int> alive_ = std::make_shared<int>(); ///< answers may come after the end
};

} // namespace hermes::ros2
