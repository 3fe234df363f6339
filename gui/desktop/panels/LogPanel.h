#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QJsonArray>
#include <QSet>
#include <QWidget>
#include <deque>

class QComboBox;
class QLineEdit;
class QPlainTextEdit;

namespace hermes {

/// The log of all daemons of all robots in one list, with filters by level and text.
class LogPanel : public QWidget {
    Q_OBJECT
public:
    static constexpr std::size_t maxRecords = 5000;

    explicit LogPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    struct Record {
        double stamp;
        QString daemon;
        int level;
        QString text;
    };

    void followAll();
    void follow(DaemonLink *daemon);
    void add(const QString &daemon, const QJsonObject &record);
    bool passes(const Record &record) const;
    void append(const Record &record);
    void refill();

    Fleet &fleet_;
    QComboBox *level_;
    QLineEdit *filter_;
    QPlainTextEdit *view_;
    std::deque<Record> records_;
    QSet<const DaemonLink *> followed_;
};

} // namespace hermes
