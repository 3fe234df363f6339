#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QPointer>
#include <QWidget>
#include <functional>

class QLineEdit;
class QPushButton;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;
class SchemaForm;

/// The settings of the chosen daemon, made from its own schema: apply, revert, defaults, save. What was
/// edited and not applied is kept for each daemon, also while it is away.
class SettingsPanel : public QWidget {
    Q_OBJECT
public:
    explicit SettingsPanel(Fleet &fleet, QWidget *parent = nullptr);
    /// The daemons of which values were edited and not applied: "motorcontrol of anna (2)".
    QStringList unapplied() const;

private:
    void follow(DaemonLink *daemon);
    void ask(const QString &method, const QJsonObject &params, const Client::Callback &done);
    void load();
    /// Applies what was edited, and tells how that ended; then goes on when it was taken.
    void submit(const std::function<void(const QString &told)> &then);
    void accept(const QJsonObject &sent);
    void save();
    void keepEdits();
    void update();
    static QString changesText(int changed, int unseen);
    QLayout *makeButtons();

    Fleet &fleet_;
    QPointer<DaemonLink> daemon_;
    QHash<QString, QJsonObject> edits_; // not applied, by the address of a daemon that is not shown
    Subscription settings_;             // the topic
    PlainLabel *title_;
    MessageLabel *message_;
    QLineEdit *filter_;
    PlainLabel *changed_; // how many, at a place that is kept for it
    SchemaForm *form_;
    QPushButton *apply_, *revert_, *defaults_, *save_;
};

} // namespace hermes::desktop
