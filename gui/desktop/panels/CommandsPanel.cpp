#include "gui/desktop/panels/CommandsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/SchemaForm.h"

#include <QElapsedTimer>
#include <QHBoxLayout>
#include <QJsonArray>
#include <QJsonDocument>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSplitter>
#include <QVBoxLayout>

namespace hermes {
namespace {

/// The parameters of a method as one object's schema.
QJsonObject parametersOf(const QJsonObject &method) {
    QJsonObject properties;
    QJsonArray required;
    for (const QJsonValue &parameter : method["params"].toArray()) {
        QJsonObject schema = parameter["schema"].toObject();
        if (!schema.contains("description"))
            schema["description"] = parameter["description"].toString();
        properties[parameter["name"].toString()] = schema;
        if (parameter["required"].toBool())
            required.append(parameter["name"]);
    }
    QJsonObject schema{{"type", "object"}, {"properties", properties}};
    if (!required.isEmpty())
        schema["required"] = required;
    return schema;
}

QString readable(const QJsonValue &value) {
    if (value.isObject())
        return QString::fromUtf8(QJsonDocument(value.toObject()).toJson());
    if (value.isArray())
        return QString::fromUtf8(QJsonDocument(value.toArray()).toJson());
    return value.isString() ? value.toString() : value.isNull() ? "null" : value.toVariant().toString();
}

} // namespace

CommandsPanel::CommandsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent) {
    auto *const splitter = new QSplitter;
    splitter->addWidget(makeMethods());
    splitter->addWidget(makeCall());
    splitter->addWidget(answer_ = new QPlainTextEdit);
    splitter->setStretchFactor(1, 2);
    splitter->setStretchFactor(2, 2);
    splitter->setSizes({220, 560, 460});
    answer_->setObjectName("answer");
    answer_->setReadOnly(true);
    answer_->setFont(theme::fixedFont());
    answer_->setPlaceholderText(tr("The answer appears here."));
    auto *const layout = new QVBoxLayout(this);
    layout->addWidget(splitter);

    connect(&fleet, &Fleet::daemonChosen, this, &CommandsPanel::follow);
    follow(fleet.daemon());
}

QWidget *CommandsPanel::makeMethods() {
    auto *const column = new QWidget;
    auto *const layout = new QVBoxLayout(column);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(title_ = new QLabel);
    layout->addWidget(filter_ = new QLineEdit);
    layout->addWidget(methods_ = new QListWidget, 1);
    title_->setObjectName("title");
    title_->setWordWrap(true);
    filter_->setObjectName("filter");
    filter_->setPlaceholderText(tr("Find a command"));
    filter_->setClearButtonEnabled(true);
    methods_->setObjectName("methods");
    connect(filter_, &QLineEdit::textChanged, this, &CommandsPanel::listMethods);
    connect(methods_, &QListWidget::currentTextChanged, this, &CommandsPanel::showMethod);
    return column;
}

QWidget *CommandsPanel::makeCall() {
    auto *const column = new QWidget;
    auto *const layout = new QVBoxLayout(column);
    layout->setContentsMargins(0, 0, 0, 0);
    auto *const method = new QWidget;
    auto *const rows = new QVBoxLayout(method);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->addWidget(summary_ = new QLabel);
    rows->addWidget(form_ = new SchemaForm, 1);
    auto *const scroll = new QScrollArea;
    scroll->setWidget(method);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    layout->addWidget(scroll, 1);
    layout->addWidget(call_ = new QPushButton(theme::icon("call"), tr("Ru&n")));
    summary_->setWordWrap(true);
    summary_->setObjectName("summary");
    call_->setObjectName("call");
    connect(form_, &SchemaForm::edited, this, &CommandsPanel::update);
    connect(call_, &QPushButton::clicked, this, &CommandsPanel::call);
    return column;
}

void CommandsPanel::follow(DaemonLink *daemon) {
    if (daemon_)
        daemon_->disconnect(this);
    daemon_ = daemon;
    if (daemon) {
        connect(daemon, &DaemonLink::described, this, &CommandsPanel::listMethods);
        connect(daemon, &DaemonLink::changed, this, &CommandsPanel::update);
    }
    answer_->clear();
    listMethods();
}

void CommandsPanel::listMethods() {
    const QString chosen = method_;
    methods_->clear();
    if (daemon_)
        for (const QJsonValue &method : daemon_->description()["methods"].toArray()) {
            const QString name = method["name"].toString();
            if (!(name + method["summary"].toString()).contains(filter_->text(), Qt::CaseInsensitive))
                continue;
            auto *const item = new QListWidgetItem(name, methods_);
            item->setToolTip(method["summary"].toString());
            if (name == chosen)
                methods_->setCurrentItem(item);
        }
    if (!methods_->currentItem() && methods_->count() > 0)
        methods_->setCurrentRow(0);
    if (methods_->count() == 0)
        showMethod({});
    update();
}

void CommandsPanel::showMethod(const QString &name) {
    if (name.isEmpty() && methods_->count() > 0)
        return; // the list is being filled
    method_ = name;
    const QJsonObject method = daemon_ ? daemon_->method(name) : QJsonObject();
    summary_->setText(method["x-needs-lease"].toBool()
                          ? method["summary"].toString() + tr(" (needs the control)")
                          : method["summary"].toString());
    form_->setSchema(parametersOf(method), {});
    update();
}

void CommandsPanel::call() {
    const QString method = method_;
    QElapsedTimer time;
    time.start();
    answer_->setPlainText(tr("%1 ...").arg(method));
    daemon_->call(method, form_->values(), this, [this, method, time](const Result<QJsonValue> &result) {
        const QString took = tr("%1: %2 ms").arg(method).arg(double(time.nsecsElapsed()) * 1e-6, 0, 'f', 1);
        if (result)
            return answer_->setPlainText(took + "\n" + readable(*result));
        const Error &error = result.error();
        answer_->setPlainText(
            tr("%1\nError %2: %3\n%4")
                .arg(took)
                .arg(error.code)
                .arg(error.message, error.data.isUndefined() ? QString() : readable(error.data)));
        form_->showErrors(error.data.toObject()["errors"].toArray());
    });
}

void CommandsPanel::update() {
    title_->setText(daemon_ ? "<b>" + daemon_->name().toHtmlEscaped() + "</b>"
                            : tr("Choose a daemon to see its commands."));
    call_->setEnabled(daemon_ && daemon_->isConnected() && !method_.isEmpty() && form_->isValid());
}

} // namespace hermes
