#pragma once

#include "gui/desktop/model/LogFeed.h"

#include <QTimer>
#include <QWidget>
#include <chrono>
#include <deque>
#include <vector>

class QComboBox;
class QLineEdit;
class QPlainTextEdit;

namespace hermes::desktop {

/// The log of all daemons of all robots in one list, with filters by level and text.
class LogPanel : public QWidget {
    Q_OBJECT
public:
    static constexpr std::size_t maxRecords = 5000;
    /// Of those that pass the filter, the newest are shown.
    static constexpr std::size_t maxLines = 500;
    static constexpr std::chrono::milliseconds refreshPeriod{100};

    explicit LogPanel(LogFeed &log, QWidget *parent = nullptr);

private:
    struct Record {
        double stamp;
        QString daemon;
        int level;
        QString text;
    };

    void add(const DaemonLink *daemon, const LogMessage &record);
    bool passes(const Record &record) const;
    void append(const std::vector<const Record *> &records);
    void refresh();
    void refill();

    const LogFeed &log_;
    QComboBox *level_;
    QLineEdit *filter_;
    QPlainTextEdit *view_;
    std::deque<Record> records_;
    std::size_t newRecords_ = 0; // not shown yet
    bool isUnsorted_ = false;
    QTimer timer_;
};

} // namespace hermes::desktop
