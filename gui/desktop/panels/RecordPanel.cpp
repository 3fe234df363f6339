#include "gui/desktop/panels/RecordPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QDateTime>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

namespace hermes {
namespace {

constexpr int longestName = 60;

QString bytesText(double bytes) {
    const char *const units[]{"B", "kB", "MB", "GB", "TB"};
    int unit = 0;
    while (bytes >= 1000 && unit < 4) {
        bytes /= 1000;
        ++unit;
    }
    return shortNumber(bytes, unit == 0 ? 0 : 1) + ' ' + units[unit];
}

QString timeText(double seconds) {
    constexpr double century_s = 3.2e9;
    if (!(seconds >= 0 && seconds < century_s))
        return RecordPanel::tr("%1 s").arg(shortNumber(seconds, 0));
    const qint64 s = qint64(seconds);
    if (s >= 3600)
        return RecordPanel::tr("%1 h %2 min").arg(s / 3600).arg(s / 60 % 60);
    return s >= 60 ? RecordPanel::tr("%1 min %2 s").arg(s / 60).arg(s % 60) : RecordPanel::tr("%1 s").arg(s);
}

QString startText(double stamp) {
    const auto start = timeOf(stamp);
    return start ? QLocale().toString(*start, QLocale::ShortFormat)
                 : RecordPanel::tr("at an impossible time: %1").arg(stamp);
}

} // namespace

RecordPanel::RecordPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , recorder_(fleet)
    , player_(fleet)
    , name_(new QLineEdit("run1"))
    , record_(new QPushButton)
    , replay_(new QPushButton(theme::icon("start"), tr("Repla&y")))
    , live_(new QPushButton(tr("&Live")))
    , amount_(new PlainLabel)
    , message_(new MessageLabel)
    , sessions_(new QTreeWidget) {
    name_->setObjectName("name");
    name_->setToolTip(tr("Of the folder in which all loggers record"));
    record_->setObjectName("record");
    replay_->setObjectName("replay");
    replay_->setToolTip(tr("Plays the chosen recording through the same topics"));
    live_->setObjectName("live");
    live_->setToolTip(tr("Ends the replay"));
    amount_->setObjectName("amount");
    amount_->setWordWrap(true);
    amount_->setMinimumWidth(1);
    sessions_->setObjectName("sessions");
    sessions_->setHeaderLabels({tr("Recording"), tr("Size")});
    sessions_->header()->setStretchLastSection(false);
    sessions_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    sessions_->header()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
    sessions_->setRootIsDecorated(false);

    auto *const top = new QHBoxLayout;
    top->addWidget(name_, 1);
    top->addWidget(record_);
    auto *const bottom = new QHBoxLayout;
    bottom->addWidget(replay_);
    bottom->addWidget(live_);
    auto *const layout = new QVBoxLayout(this);
    layout->addLayout(top);
    layout->addWidget(amount_);
    layout->addWidget(sessions_, 1);
    layout->addLayout(bottom);
    layout->addWidget(message_);

    connect(record_, &QPushButton::clicked, this, [this] {
        if (recorder_.isRecording())
            recorder_.stop();
        else
            recorder_.start(name_->text().trimmed());
    });
    connect(name_, &QLineEdit::returnPressed, record_, &QPushButton::click);
    connect(replay_, &QPushButton::clicked, this, [this] {
        const int row = sessions_->indexOfTopLevelItem(sessions_->currentItem());
        if (row >= 0 && row < recorder_.sessions().size())
            player_.play(recorder_.sessions()[row].toObject(), 1);
    });
    connect(live_, &QPushButton::clicked, &player_, &SessionPlayer::live);
    connect(sessions_, &QTreeWidget::currentItemChanged, this, &RecordPanel::update);
    connect(&recorder_, &SessionRecorder::changed, this, &RecordPanel::update);
    connect(&recorder_, &SessionRecorder::told, message_, &MessageLabel::tell);
    connect(&player_, &SessionPlayer::changed, this, &RecordPanel::update);
    connect(&player_, &SessionPlayer::told, message_, &MessageLabel::tell);
    update();
}

void RecordPanel::update() {
    const bool isRecording = recorder_.isRecording();
    record_->setText(isRecording ? tr("S&top") : tr("Re&cord"));
    record_->setIcon(theme::icon(isRecording ? "stop" : "record"));
    record_->setEnabled(!recorder_.loggers().empty() && (isRecording || !name_->text().trimmed().isEmpty()));
    name_->setEnabled(!isRecording);
    showAmount();
    showSessions();
    replay_->setEnabled(sessions_->currentItem() && !isRecording);
    live_->setEnabled(player_.isPlaying());
}

void RecordPanel::showAmount() {
    if (recorder_.loggers().empty())
        return amount_->setText(tr("No logger is connected."));
    if (!recorder_.isRecording()) {
        QStringList names;
        for (const SessionRecorder::Logger &logger : recorder_.loggers())
            if (logger.daemon)
                names.append(logger.daemon->name());
        QString text = tr("Records with %1.").arg(names.join(", "));
        if (recorder_.unlisted() > 0)
            text += ' ' + tr("%1 older recordings are not listed.").arg(recorder_.unlisted());
        return amount_->setText(text);
    }
    QString text = tr("%1: %2, %3")
                       .arg(shortLine(recorder_.name(), longestName), timeText(recorder_.seconds()),
                            bytesText(recorder_.bytes()));
    if (recorder_.secondsLeft() > 0)
        text += tr(", the disk will do for %1").arg(timeText(recorder_.secondsLeft()));
    for (const SessionRecorder::Logger &logger : recorder_.loggers())
        if (logger.daemon && logger.losses() > 0)
            text += tr("; %1 misses %2").arg(logger.daemon->name()).arg(logger.losses());
    amount_->setText(text);
}

void RecordPanel::showSessions() {
    const QJsonArray &sessions = recorder_.sessions();
    while (sessions_->topLevelItemCount() > sessions.size())
        delete sessions_->takeTopLevelItem(sessions_->topLevelItemCount() - 1);
    while (sessions_->topLevelItemCount() < sessions.size())
        sessions_->addTopLevelItem(new QTreeWidgetItem);
    for (int i = 0; i < sessions.size(); ++i) {
        const QJsonObject session = sessions[i].toObject();
        const bool isComplete = session["complete"].toBool();
        const bool goesOn = session["name"].toString() == recorder_.name();
        QStringList loggers;
        for (const QJsonValue &part : session["parts"].toArray())
            loggers.append(part["logger"].toString());
        QTreeWidgetItem *const item = sessions_->topLevelItem(i);
        item->setText(0, shortLine(session["name"].toString(), longestName));
        item->setText(1, bytesText(session["bytes"].toDouble()));
        item->setIcon(0, theme::icon(isComplete ? Condition::Ready
                                     : goesOn   ? Condition::Busy
                                                : Condition::Warning));
        item->setToolTip(0,
                         toolTipOf(tr("%1\n%2\n%3")
                                       .arg(startText(session["start"].toDouble()), loggers.join(", "),
                                            isComplete ? tr("complete")
                                            : goesOn   ? tr("going on")
                                                       : tr("not complete: cut off, or ended by an error"))));
    }
}

} // namespace hermes
