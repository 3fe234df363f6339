#pragma once

#include "gui/hermesctl/Arguments.h"
#include "gui/hermesctl/Connection.h"

namespace hermes {

/// The loggers of a robot: the daemons that answer and describe the command record.start.
class Loggers {
public:
    using Replies = std::vector<Result<QJsonValue>>;
    using Numbers = std::vector<std::size_t>;

    /// Those that --daemons names, of which each must be one; else those at the default ports of the host.
    static Result<Loggers> find(const Arguments &arguments);

    std::size_t size() const { return members_.size(); }
    Numbers everyone() const;
    const QString &name(std::size_t number) const { return members_[number].name; }
    /// What answers at a default port but does not say what it is, and why.
    const QStringList &silent() const { return silent_; }

    /// Calls a method of some at the same time; the replies are in the order of the numbers. atLeast: how
    /// long a reply may take, whatever --timeout says.
    Replies call(const Numbers &numbers, const QString &method, const QJsonObject &params = {},
                 std::chrono::milliseconds atLeast = {}) const;
    /// With parameters for each.
    Replies callEach(const Numbers &numbers, const QString &method, const std::vector<QJsonObject> &params,
                     std::chrono::milliseconds atLeast = {}) const;
    Replies call(const QString &method, const QJsonObject &params = {}) const {
        return call(everyone(), method, params);
    }

private:
    struct Member {
        QString name;
        std::unique_ptr<Client> client;
    };

    void keepThoseThatRecord(QStringList &others);

    std::vector<Member> members_;
    QStringList silent_;
    std::chrono::milliseconds timeout_{};
};

} // namespace hermes
