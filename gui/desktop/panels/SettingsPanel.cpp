#include "gui/desktop/panels/SettingsPanel.h"

#include "common/settings/DottedPath.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/SchemaForm.h"

#include <QJsonArray>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>

namespace hermes::desktop {

SettingsPanel::SettingsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , title_(named(new PlainLabel, "title"))
    , message_(new MessageLabel)
    , filter_(named(new QLineEdit, "filter"))
    , changed_(named(new PlainLabel, "changed", tr("What is typed and not applied")))
    , form_(new SchemaForm) {
    filter_->setPlaceholderText(tr("Find a setting"));
    filter_->setClearButtonEnabled(true);
    setLayout(inColumn({inRow({title_, {filter_, 1}, makeButtons()}),
                        {scrolled(form_), 1},
                        inRow({{message_, 1}, {changed_, 0, Qt::AlignTop}})})); // where no row moves with it
    changed_->setFixedWidth(fontMetrics().horizontalAdvance(changesText(999, 999)));
    changed_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);

    connect(filter_, &QLineEdit::textChanged, this, [this](const QString &text) {
        form_->setFilter(text);
        update();
    });
    connect(form_, &SchemaForm::edited, this, [this] {
        message_->hide();
        if (const QString wrong = form_->firstError(); !wrong.isEmpty()) // it may not be in sight
            message_->tell(tr("Nothing is applied before this is mended: %1").arg(wrong), true, true);
        update();
    });
    connect(&fleet, &Fleet::daemonChosen, this, &SettingsPanel::follow);
    connect(&fleet, &Fleet::changed, this, &SettingsPanel::update);
    follow(fleet.daemon());
}

QLayout *SettingsPanel::makeButtons() {
    const auto button = [](const QString &icon, const QString &text, const char *name) {
        return named(new QPushButton(theme::icon(icon), text), name);
    };
    apply_ = button("apply", tr("A&pply"), "apply");
    revert_ = button("revert", tr("Re&vert"), "revert");
    revert_->setToolTip(tr("Forgets the changes that were not applied"));
    defaults_ = button("restart", tr("De&faults"), "defaults");
    save_ = button("save", tr("&Save"), "save");
    connect(apply_, &QPushButton::clicked, this,
            [this] { submit([this](const QString &told) { message_->tell(told); }); });
    connect(revert_, &QPushButton::clicked, this, [this] {
        form_->revert();
        update();
    });
    connect(defaults_, &QPushButton::clicked, form_, &SchemaForm::setDefaults);
    connect(save_, &QPushButton::clicked, this, &SettingsPanel::save);
    return inRow({apply_, revert_, defaults_, save_});
}

void SettingsPanel::follow(DaemonLink *daemon) {
    if (daemon_)
        daemon_->disconnect(this);
    settings_.reset();
    keepEdits();
    daemon_ = daemon;
    form_->setSchema({}, {});
    if (daemon) {
        connect(daemon, &DaemonLink::ready, this, [this] { load(); });
        connect(daemon, &DaemonLink::changed, this, &SettingsPanel::update);
        settings_ = daemon->subscribe("settings", {{"max_rate_hz", 5}}, [this](const TopicUpdate &update) {
            form_->setBaseline(update.json().toObject());
            this->update();
        });
        if (daemon->isConnected())
            load();
    }
    update();
}

QStringList SettingsPanel::unapplied() const {
    QHash<QString, QJsonObject> all = edits_;
    if (daemon_)
        all[daemon_->address()] = form_->changes();
    QStringList found;
    for (auto one = all.cbegin(); one != all.cend(); ++one) {
        const DaemonLink *const daemon = fleet_.daemonAt(one.key());
        if (const int count = leafPaths(*one).size())
            found.append(tr("%1 (%2)").arg(daemon ? fleet_.titleOf(*daemon) : one.key()).arg(count));
    }
    found.sort();
    return found;
}

void SettingsPanel::keepEdits() {
    message_->hide();
    const QJsonObject changes = form_->changes();
    if (!daemon_ || changes.isEmpty())
        return;
    edits_[daemon_->address()] = changes;
    message_->tell(tr("%1 keeps %n change(s) that are not applied", nullptr, leafPaths(changes).size())
                       .arg(daemon_->name()));
}

/// done is told unless another daemon is shown by then.
void SettingsPanel::ask(const QString &method, const QJsonObject &params, const Client::Callback &done) {
    daemon_->call(method, params, this, [this, asked = daemon_, done](const Result<QJsonValue> &reply) {
        if (asked && asked == daemon_)
            done(reply);
    });
}

void SettingsPanel::load() {
    ask("settings.schema", {}, [this](const Result<QJsonValue> &schema) {
        if (!schema || !schema->isObject())
            return message_->tell(schema ? tr("It does not describe its settings") : schema.error().message,
                                  true);
        const QJsonObject found = schema->toObject();
        ask("settings.get", {}, [this, found](const Result<QJsonValue> &values) {
            if (!values || !values->isObject())
                return message_->tell(values ? tr("It does not tell its settings") : values.error().message,
                                      true);
            const QJsonObject kept = edits_.take(daemon_->address()), typed = form_->changes();
            form_->setSchema(found, values->toObject());
            form_->setFilter(filter_->text());
            form_->edit(kept);
            form_->edit(typed);
            update();
        });
    });
}

void SettingsPanel::submit(const std::function<void(const QString &told)> &then) {
    const QJsonObject sent = form_->changes();
    ask("settings.set", {{"values", sent}}, [=](const Result<QJsonValue> &done) {
        if (!done) {
            form_->showErrors(done.error().data.toObject()["errors"].toArray());
            return message_->tell(done.error().message, true);
        }
        QStringList restart;
        for (const QJsonValue &path : (*done)["restart"].toArray())
            restart.append(path.toString());
        accept(sent);
        then(restart.isEmpty() ? tr("Applied.")
                               : tr("Applied. Needs a restart of the daemon: %1").arg(restart.join(", ")));
    });
}

/// The daemon may keep other values than were sent, as rounded ones.
void SettingsPanel::accept(const QJsonObject &sent) {
    form_->setBaseline(merged(form_->baseline(), sent));
    update();
    ask("settings.get", {}, [this](const Result<QJsonValue> &values) {
        if (!values || !values->isObject())
            return;
        form_->setBaseline(values->toObject());
        update();
    });
}

void SettingsPanel::save() {
    const auto keep = [this](const QString &told) {
        ask("settings.save", {}, [this, told](const auto &done) {
            if (done)
                message_->tell(told + tr("Saved: the daemon begins with these settings the next time."));
            else
                message_->tell(told + done.error().message, true);
        });
    };
    if (form_->changes().isEmpty())
        return keep({});
    submit([keep](const QString &told) { keep(told + ' '); });
}

/// "3 changes, 2 not in sight"
QString SettingsPanel::changesText(int changed, int unseen) {
    if (changed == 0)
        return {};
    const QString text = changed == 1 ? tr("1 change") : tr("%1 changes").arg(changed);
    return unseen == 0 ? text : tr("%1, %2 not in sight").arg(text).arg(unseen);
}

// Texts of buttons stay as they are: what is beside them would move under the mouse.
void SettingsPanel::update() {
    const bool isThere = daemon_ && daemon_->isConnected();
    title_->setBold(daemon_);
    title_->setText(daemon_ ? fleet_.titleOf(*daemon_) : tr("Choose a daemon to see its settings."));
    const int changed = leafPaths(form_->changes()).size();
    changed_->setText(changesText(changed, form_->unseenChanges()));
    const QString why = isThere ? daemon_->refusal("settings.set") : QString();
    const bool isEditable = isThere && why.isEmpty();
    const auto explain = [&why](QWidget *button, const QString &text) {
        button->setToolTip(why.isEmpty() ? text : why);
    };
    explain(apply_, tr("Sends the changes: all of them, or none when one is refused"));
    explain(defaults_, filter_->text().isEmpty()
                           ? tr("Shows the defaults; Apply makes them true")
                           : tr("Shows the defaults of the settings in sight; Apply makes them true"));
    explain(save_, tr("Applies the changes; the daemon keeps its settings for its next start"));
    apply_->setEnabled(isEditable && changed > 0 && form_->isValid());
    revert_->setEnabled(daemon_ && (changed > 0 || !form_->isValid()));
    defaults_->setEnabled(isEditable);
    save_->setEnabled(isEditable && form_->isValid()); // what is wrong would be left out
    form_->setEnabled(isEditable);
    form_->setToolTip(why);
}

} // namespace hermes::desktop
