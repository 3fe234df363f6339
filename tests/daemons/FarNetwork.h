#pragma once

#include <QStringList>

#include <cerrno>
#include <cstring>
#include <sched.h>

/// A second computer, as far as the network goes: a network namespace, and a cable to it (veth) that can be
/// pulled at its end. This process moves to a namespace of its own, so that nothing else sees either.
class FarNetwork {
public:
    static constexpr const char *nearHost = "192.168.77.1";

    /// Empty, or why there is none.
    QString make() {
        if (::unshare(CLONE_NEWNET) != 0)
            return QString("no network namespace (needs root rights): %1").arg(std::strerror(errno));
        far_.start("unshare", {"-n", "cat"}); // until its input is closed
        if (!far_.waitForStarted() ||
            !QTest::qWaitFor([this] { return namespaceOf(pid()) != namespaceOf("self"); }))
            return "the program unshare makes no network namespace";
        enter_ = QStringList{"nsenter", "-t", pid(), "-n"};
        const QStringList commands{"ip link set lo up",
                                   "ip link add near type veth peer name far netns " + pid(),
                                   QString("ip addr add %1/30 dev near").arg(nearHost),
                                   "ip link set near up",
                                   enter_.join(' ') + " ip addr add 192.168.77.2/30 dev far",
                                   enter_.join(' ') + " ip link set far up"};
        for (const QString &command : commands) {
            const QString wrong = run(command);
            if (!wrong.isEmpty())
                return wrong;
        }
        return {};
    }
    /// Empty, or what went wrong.
    QString setLink(bool up) {
        return run(enter_.join(' ') + (up ? " ip link set far up" : " ip link set far down"));
    }
    /// A command that runs what follows it on the far computer.
    const QStringList &enter() const { return enter_; }
    ~FarNetwork() {
        far_.closeWriteChannel();
        far_.waitForFinished(1000);
    }

private:
    QString pid() const { return QString::number(far_.processId()); }
    static QString namespaceOf(const QString &process) {
        return QFile::symLinkTarget("/proc/" + process + "/ns/net");
    }
    static QString run(const QString &command) {
        QProcess process;
        QStringList words = command.split(' ');
        const QString program = words.takeFirst();
        process.start(program, words);
        if (process.waitForFinished() && process.exitStatus() == QProcess::NormalExit &&
            process.exitCode() == 0)
            return {};
        return command + ": " + process.errorString() + ' ' + process.readAllStandardError();
    }

    QProcess far_;
    QStringList enter_;
};
