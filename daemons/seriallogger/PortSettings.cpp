#include "daemons/seriallogger/PortSettings.h"

#include "common/interface/InterfaceRegistry.h"

#include <QJsonArray>
#include <QSet>

namespace hermes::seriallogger {

namespace {

/// What is wrong with an address, or an empty text.
QString complaint(const QString &text) {
    const Result<InterfaceUrl> url = InterfaceUrl::parse(text);
    if (!url)
        return url.error().message;
    if (!interfaceSchemes().contains(url->scheme))
        return QString("an address that begins with one of: %1").arg(interfaceSchemes().join(", "));
    if (url->scheme == "serial" && url->path.isEmpty())
        return "a device, as in serial:///dev/serial/by-id/NAME?baud=115200";
    if (url->scheme == "tcp" && (url->host.isEmpty() || url->port == 0))
        return "a host and a port, as in tcp://192.168.1.7:4001";
    return {};
}

} // namespace

Field PortSettings::field() {
    const QJsonObject text{{"type", "string"}};
    const QJsonObject item{
        {"type", "object"},
        {"properties",
         QJsonObject{{"name", QJsonObject{{"type", "string"},
                                          {"pattern", "^[A-Za-z0-9_-]{1,32}$"},
                                          {"description", "Of its files: letters, digits, - and _"}}},
                     {"url", QJsonObject{{"type", "string"},
                                         {"description", "serial:///dev/serial/by-id/NAME?baud=115200, "
                                                         "udp://0.0.0.0:PORT or tcp://HOST:PORT"}}},
                     {"view", QJsonObject{{"type", "string"},
                                          {"enum", QJsonArray{"none", "lines", "nmea"}},
                                          {"description", "What is published: nothing, its lines, or lines "
                                                          "and the fixes of a GPS receiver"}}},
                     {"checksum", QJsonObject{{"type", "string"},
                                              {"enum", QJsonArray{"strict", "lenient"}},
                                              {"description", "NMEA sentences without one: refused, or "
                                                              "accepted; a wrong one is always refused"}}},
                     {"silence_s", QJsonObject{{"type", "number"},
                                               {"minimum", 0},
                                               {"maximum", 1e6},
                                               {"description", "Without a byte for so long its health is "
                                                               "stale; 0: never. Usual: 5 in nmea"}}}}},
        {"required", QJsonArray{"name", "url"}},
        {"additionalProperties", false}};
    return Field::array(
               "ports",
               "What to log: name and url of each port; view (lines), checksum (strict), silence_s (0, 5)",
               item)
        .with("maxItems", 64)
        .byDefault(QJsonArray())
        .appliesOnRestart()
        .group("Ports");
}

constexpr double receiverSilence_s = 5; // a GPS receiver talks each second

std::vector<PortSettings> PortSettings::read(const QJsonObject &settings) {
    std::vector<PortSettings> ports;
    for (const QJsonValue &value : settings.value("ports").toArray()) {
        const QJsonObject object = value.toObject();
        const QString view = object.value("view").toString("lines");
        PortSettings port;
        port.name = object.value("name").toString();
        port.url = object.value("url").toString();
        port.view = view == "none" ? View::None : view == "nmea" ? View::Nmea : View::Lines;
        port.checksum =
            object.value("checksum") == "lenient" ? nmea::ChecksumRule::Lenient : nmea::ChecksumRule::Strict;
        port.silence_s = object.value("silence_s").toDouble(port.view == View::Nmea ? receiverSilence_s : 0);
        ports.push_back(port);
    }
    return ports;
}

std::vector<SchemaViolation> PortSettings::check(const QJsonObject &settings) {
    std::vector<SchemaViolation> wrong;
    QSet<QString> names;
    int number = 0;
    for (const PortSettings &port : read(settings)) {
        const QString path = QString("ports.%1.").arg(number++);
        if (names.contains(port.name))
            wrong.push_back({path + "name", port.name, "a name that no other port has"});
        names.insert(port.name);
        if (const QString expected = complaint(port.url); !expected.isEmpty())
            wrong.push_back({path + "url", port.url, expected});
    }
    return wrong;
}

} // namespace hermes::seriallogger
