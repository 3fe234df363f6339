#pragma once

#include "common/Result.h"

#include <QByteArray>
#include <QJsonObject>
#include <QMap>
#include <QStringList>
#include <vector>

class QJsonArray;
class QVariant;

namespace hermes::desktop {

/// As it is kept in a file, and what is kept there.
QString compactText(const QJsonValue &objectOrList);
QJsonObject objectOf(const QVariant &text);

/// What of the window is kept between runs, in a JSON file: layouts by name, and the robots apart from them.
/// A file that is no such one, or damaged, is left as it is: the window has its default then, and nothing is
/// kept.
class Layouts {
public:
    static constexpr int longestName = 40, most = 50;

    struct Layout {
        QByteArray geometry, state; ///< as QMainWindow saves them; empty: the default
        QJsonObject plots;

        bool operator==(const Layout &other) const {
            return geometry == other.geometry && state == other.state && plots == other.plots;
        }
    };
    struct Robots {
        QStringList addresses;
        QMap<QString, QString> names; ///< given ones, by id
        QString chosen;               ///< id

        bool operator==(const Robots &other) const {
            return addresses == other.addresses && names == other.names && chosen == other.chosen;
        }
    };

    /// file: empty: nothing is kept, and that is no problem.
    explicit Layouts(const QString &file);
    const QString &file() const { return file_; }

    /// Of what was read, to be compared with that of a file; empty: there was none.
    const QByteArray &fingerprint() const { return fingerprint_; }
    static QByteArray fingerprintOf(const QString &file);

    /// Why nothing is kept; empty: it is.
    const QString &problem() const { return problem_; }
    /// What of the file is not as it was written, and was passed over; empty: nothing.
    const QString &damage() const { return damage_; }
    /// At least one.
    QStringList names() const;
    const QString &current() const { return current_; }
    /// Of the current one.
    Layout layout() const;
    void setLayout(const Layout &layout);

    /// Error: there is none of that name.
    Result<void> choose(const QString &name);
    /// A copy of the current one, which is the current one then. Error: what is wrong with the name.
    Result<void> saveAs(const QString &name);
    /// The current one; the first of the others is the current one then. Error: it is the last.
    Result<void> remove();

    const Robots &robots() const { return robots_; }
    void setRobots(const Robots &robots) { put(robots_, robots); }
    /// What else is kept, of all layouts.
    QString value(const QString &key) const { return values_.value(key); }
    void setValue(const QString &key, const QString &text) { put(values_[key], text); }

    /// Since it was read, or taken.
    bool isChanged() const { return isChanged_; }
    /// A copy of all as it is now, to be saved in another thread.
    Layouts take() {
        isChanged_ = false;
        return *this;
    }
    /// Error: why it could not be written.
    Result<void> save() const;

private:
    struct Named {
        QString name;
        Layout layout;
    };

    template <typename T>
    void put(T &kept, const T &wanted) {
        isChanged_ = isChanged_ || !(kept == wanted);
        kept = wanted;
    }
    QByteArray json() const;
    void read();
    void readLayouts(const QJsonArray &array);
    std::vector<Named>::iterator find(const QString &name);

    const QString file_;
    QByteArray fingerprint_;
    QString problem_, damage_, current_;
    std::vector<Named> layouts_;
    Robots robots_;
    QMap<QString, QString> values_;
    bool isChanged_ = false;
};

} // namespace hermes::desktop
