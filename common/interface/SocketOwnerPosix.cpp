#include "common/interface/SocketOwner.h"

#include "common/interface/SocketTable.h"

#include <QFile>
#include <arpa/inet.h>
#include <array>
#include <cstring>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes {
namespace {

struct Question {
    nlmsghdr header{};
    inet_diag_req_v2 request{};
};

void put(const QHostAddress &address, __be32 (&words)[4]) {
    bool isFour = false;
    const quint32 four = address.toIPv4Address(&isFour);
    if (isFour) {
        words[0] = htonl(four);
    } else {
        const Q_IPV6ADDR six = address.toIPv6Address();
        std::memcpy(words, &six, sizeof six);
    }
}

Question questionFor(const SocketEnd &from, const SocketEnd &to) {
    Question question;
    question.header.nlmsg_len = sizeof question;
    question.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
    question.header.nlmsg_flags = NLM_F_REQUEST;
    bool isFour = false;
    from.address.toIPv4Address(&isFour);
    question.request.sdiag_family = isFour ? AF_INET : AF_INET6;
    question.request.sdiag_protocol = IPPROTO_TCP;
    question.request.idiag_states = ~0U;
    inet_diag_sockid &id = question.request.id;
    id.idiag_sport = htons(from.port);
    id.idiag_dport = htons(to.port);
    put(from.address, id.idiag_src);
    put(to.address, id.idiag_dst);
    id.idiag_cookie[0] = id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
    return question;
}

/// Where there is no sock_diag: in a kernel without it, and in an emulator.
std::optional<unsigned> ownerInTables(const SocketEnd &from, const SocketEnd &to) {
    for (const char *name : {"/proc/net/tcp", "/proc/net/tcp6"}) {
        QFile table(QString::fromLatin1(name));
        if (!table.open(QIODevice::ReadOnly))
            continue;
        if (const auto user = ownerInSocketTable(table.readAll(), from, to))
            return user;
    }
    return std::nullopt;
}

} // namespace

std::optional<unsigned> ownerOfSocket(const SocketEnd &from, const SocketEnd &to) {
    const int descriptor = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_SOCK_DIAG);
    if (descriptor < 0)
        return ownerInTables(from, to);
    const Question question = questionFor(from, to);
    alignas(nlmsghdr) std::array<char, 4096> answer{};
    // The kernel answers within send().
    const bool asked = ::send(descriptor, &question, sizeof question, 0) == ssize_t(sizeof question);
    const ssize_t got = asked ? ::recv(descriptor, answer.data(), answer.size(), 0) : -1;
    ::close(descriptor);
    nlmsghdr header{};
    inet_diag_msg found{};
    if (got < ssize_t(NLMSG_HDRLEN + sizeof found))
        return std::nullopt;
    std::memcpy(&header, answer.data(), sizeof header);
    if (header.nlmsg_type != SOCK_DIAG_BY_FAMILY)
        return std::nullopt;
    std::memcpy(&found, answer.data() + NLMSG_HDRLEN, sizeof found);
    const bool isIt = found.id.idiag_sport == question.request.id.idiag_sport &&
                      found.id.idiag_dport == question.request.id.idiag_dport;
    // A socket that its program has closed is of nobody, which reads as root.
    const bool isHeld = found.idiag_inode != 0;
    return isIt && isHeld ? std::optional<unsigned>(found.idiag_uid) : std::nullopt;
}

} // namespace hermes
