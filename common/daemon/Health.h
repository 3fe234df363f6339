#pragma once

#include "protocol/messages/Daemons.h"

#include <QMap>
#include <QObject>
#include <chrono>
#include <functional>

namespace hermes {

/// Ok: as it should be. Warn: works, somebody should look. Failed ("error"): does not work. Stale: not heard
/// of in time.
enum class HealthLevel { Ok, Warn, Failed, Stale };

QString toString(HealthLevel level);

/// The health items of a daemon, as daemon.status shows them.
class Health : public QObject {
    Q_OBJECT
public:
    explicit Health(QObject *parent)
        : QObject(parent) {}

    /// Sets an item, new or known. message is a sentence for people, values are what stands behind it.
    void set(const QString &name, HealthLevel level, const QString &message, const QJsonObject &values = {});
    /// An item that is computed each time somebody asks; the function calls set(name, ...).
    void provide(const QString &name, std::function<void()> update);
    void remove(const QString &name);
    /// The item counts as stale when set() was not called for that long.
    void expectEvery(const QString &name, std::chrono::milliseconds period);

    /// The items as they stand.
    std::vector<HealthItem> list();
    /// The worst level of all items as they stand.
    HealthLevel worst() const;

Q_SIGNALS:
    /// The level of an item changed.
    void changed();

private:
    struct Item {
        HealthLevel level = HealthLevel::Ok;
        QString message;
        QJsonObject values;
        double set = 0;    // monotonic
        double period = 0; // seconds; 0: never stale
        std::function<void()> update;

        HealthLevel levelNow() const;
    };

    QMap<QString, Item> items_;
};

} // namespace hermes
