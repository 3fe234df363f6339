#include "daemons/ros2/SocketGuard.h"

#include <QDir>
#include <QNetworkInterface>

#include <linux/filter.h>
#include <net/if.h>
#include <sys/socket.h>

namespace hermes::ros2 {
namespace {

/// Of this process.
std::set<int> datagramSockets() {
    std::set<int> found;
    for (const QString &name : QDir("/proc/self/fd").entryList(QDir::AllEntries | QDir::System)) {
        bool isNumber = false;
        const int descriptor = name.toInt(&isNumber);
        int kind = 0, family = 0;
        socklen_t size = sizeof kind;
        if (!isNumber || ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 ||
            kind != SOCK_DGRAM)
            continue;
        size = sizeof family;
        if (::getsockopt(descriptor, SOL_SOCKET, SO_DOMAIN, &family, &size) == 0 &&
            (family == AF_INET || family == AF_INET6))
            found.insert(descriptor);
    }
    return found;
}

/// Accepts what came in over one of these interfaces.
std::vector<sock_filter> filterFor(const std::set<unsigned> &interfaces) {
    std::vector<sock_filter> code{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, std::uint32_t(SKF_AD_OFF + SKF_AD_IFINDEX))};
    std::size_t left = interfaces.size();
    for (const unsigned index : interfaces)
        code.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, index, std::uint8_t(left--), 0));
    code.push_back(BPF_STMT(BPF_RET | BPF_K, 0));
    code.push_back(BPF_STMT(BPF_RET | BPF_K, 0xffffffff));
    return code;
}

} // namespace

SocketGuard::SocketGuard(const QStringList &networks)
    : networks_(networks)
    , before_(datagramSockets()) {}

Result<std::set<unsigned>> SocketGuard::interfaces() const {
    const QList<QNetworkInterface> all = QNetworkInterface::allInterfaces();
    std::set<unsigned> indexes;
    for (const QNetworkInterface &one : all)
        if (one.flags().testFlag(QNetworkInterface::IsLoopBack))
            indexes.insert(unsigned(one.index()));
    for (const QString &network : networks_) {
        const std::size_t before = indexes.size();
        QStringList names;
        for (const QNetworkInterface &one : all) {
            names.append(one.name());
            bool isIt = one.name() == network;
            for (const QNetworkAddressEntry &entry : one.addressEntries())
                isIt = isIt || entry.ip().toString() == network;
            if (isIt)
                indexes.insert(unsigned(one.index()));
        }
        if (indexes.size() == before && network != "lo" && !network.startsWith("127."))
            return Error(ErrorCode::DeviceFault,
                         QString("networks: found no interface \"%1\", expected one of %2, or an "
                                 "address of one")
                             .arg(network, names.join(", ")));
    }
    constexpr std::size_t maxInterfaces = 200; // jumps are short
    if (indexes.size() > maxInterfaces)
        return Error(ErrorCode::DeviceFault, "networks: too many interfaces");
    return indexes;
}

Result<void> SocketGuard::check() const {
    const auto allowed = interfaces();
    return allowed ? Result<void>() : allowed.error();
}

Result<void> SocketGuard::guardNewSockets() const {
    const auto allowed = interfaces();
    if (!allowed)
        return allowed.error();
    std::vector<sock_filter> code = filterFor(*allowed);
    const sock_fprog program{std::uint16_t(code.size()), code.data()};
    for (const int descriptor : datagramSockets())
        if (before_.count(descriptor) == 0 &&
            ::setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) != 0)
            return Error(
                ErrorCode::DeviceFault,
                QString("the sockets of DDS cannot be kept from other networks: %1").arg(strerror(errno)));
    return {};
}

} // namespace hermes::ros2
