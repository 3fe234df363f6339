#include "gui/desktop/panels/LogPanel.h"

#include "common/Time.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QComboBox>
#include <QDateTime>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QScrollBar>
#include <QTextCursor>
#include <algorithm>
#include <utility>

namespace hermes::desktop {
namespace {

const QStringList levels{"debug", "info", "warning", "error"};
constexpr int usualLevel = 1;
constexpr int longestRecord = 500, nameColumn = 24;

QBrush colourOf(int level) {
    return level == 3   ? QBrush(theme::colour(Condition::Fault))
           : level == 2 ? QBrush(theme::colour(Condition::Warning))
                        : QBrush(Qt::NoBrush);
}

} // namespace

LogPanel::LogPanel(LogFeed &log, QWidget *parent)
    : QWidget(parent)
    , log_(log)
    , level_(named(new QComboBox, "level"))
    , filter_(named(new QLineEdit, "filter"))
    , view_(named(new QPlainTextEdit, "records")) {
    level_->addItems({tr("all"), tr("info and above"), tr("warnings and errors"), tr("errors")});
    level_->setCurrentIndex(1);
    filter_->setPlaceholderText(tr("Show only lines with this text"));
    filter_->setClearButtonEnabled(true);
    view_->setReadOnly(true);
    view_->setFont(theme::fixedFont());
    view_->setLineWrapMode(QPlainTextEdit::NoWrap);
    view_->setMaximumBlockCount(int(maxLines));
    view_->setUndoRedoEnabled(false);
    view_->setPlaceholderText(tr("What the daemons log appears here."));

    auto *const label = new PlainLabel(tr("Sho&w"));
    label->setBuddy(level_);
    setLayout(inColumn({inRow({label, level_, {filter_, 1}}), view_}));

    connect(level_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &LogPanel::refill);
    connect(filter_, &QLineEdit::textChanged, this, &LogPanel::refill);
    connect(&log, &LogFeed::recorded, this, &LogPanel::add);
    connect(&timer_, &QTimer::timeout, this, &LogPanel::refresh);
    timer_.setSingleShot(true);
}

void LogPanel::add(const DaemonLink *daemon, const LogMessage &record) {
    // Sorted by the time at which it came, and with a level that is shown, where it has none that makes
    // sense.
    const int level = levels.indexOf(record.level);
    const Record made{timeOf(record.stamp) ? record.stamp : stampNow(), log_.nameOf(*daemon),
                      level < 0 ? usualLevel : level,
                      shortLine(record.source + ": " + record.text, longestRecord)};
    isUnsorted_ = isUnsorted_ || (!records_.empty() && made.stamp < records_.back().stamp);
    records_.push_back(made);
    ++newRecords_;
    if (!timer_.isActive())
        timer_.start(refreshPeriod);
}

// A daemon may log faster than anybody can read: what came since the last time is shown at once.
void LogPanel::refresh() {
    if (std::exchange(isUnsorted_, false)) {
        std::stable_sort(records_.begin(), records_.end(),
                         [](const Record &one, const Record &other) { return one.stamp < other.stamp; });
        newRecords_ = records_.size();
        view_->clear();
    }
    if (records_.size() > maxRecords)
        records_.erase(records_.begin(), records_.end() - maxRecords);
    std::vector<const Record *> shown;
    const std::size_t count = std::min(std::exchange(newRecords_, 0), records_.size());
    for (auto record = records_.end() - std::ptrdiff_t(count); record != records_.end(); ++record)
        if (passes(*record))
            shown.push_back(&*record);
    append(shown);
}

bool LogPanel::passes(const Record &record) const {
    const QString text = filter_->text();
    return record.level >= level_->currentIndex() &&
           (text.isEmpty() || record.text.contains(text, Qt::CaseInsensitive) ||
            record.daemon.contains(text, Qt::CaseInsensitive));
}

void LogPanel::append(const std::vector<const Record *> &records) {
    const bool isAtEnd = view_->verticalScrollBar()->value() == view_->verticalScrollBar()->maximum();
    QTextCursor cursor(view_->document());
    cursor.beginEditBlock();
    cursor.movePosition(QTextCursor::End);
    const std::size_t first = records.size() - std::min(records.size(), maxLines);
    for (std::size_t i = first; i < records.size(); ++i) {
        const Record &record = *records[i];
        if (!view_->document()->isEmpty())
            cursor.insertBlock();
        QTextCharFormat format;
        if (const QBrush colour = colourOf(record.level); colour != Qt::NoBrush)
            format.setForeground(colour);
        const QDateTime time = timeOf(record.stamp).value_or(QDateTime());
        cursor.insertText(QString("%1  %2  %3  %4")
                              .arg(time.toString("HH:mm:ss.zzz"),
                                   shortLine(record.daemon, nameColumn).leftJustified(nameColumn),
                                   levels.value(record.level, "?").leftJustified(7), record.text),
                          format);
    }
    cursor.endEditBlock();
    if (isAtEnd)
        view_->verticalScrollBar()->setValue(view_->verticalScrollBar()->maximum());
}

void LogPanel::refill() {
    view_->clear();
    newRecords_ = records_.size();
    refresh();
}

} // namespace hermes::desktop
