#pragma once

#include "gui/desktop/model/Fleet.h"
#include "protocol/messages/Setup.h"

#include <QWidget>

class QCheckBox;
class QComboBox;
class QProgressBar;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace hermes::desktop {

class MessageLabel;

/// The first contact with the chosen robot, through its supervisor: finds what is plugged in, shows which
/// settings would change, tests the wheels, writes the settings, and puts them back.
class SetupPanel : public QWidget {
    Q_OBJECT
public:
    explicit SetupPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    template <typename T>
    using Then = std::function<void(const T &)>;

    QWidget *makeSteps();
    void follow();
    void updateButtons();
    void find();
    void propose();
    void apply();
    void undo();
    /// Calls the supervisor; one at a time. What is wrong is told here.
    template <typename T>
    void call(const QString &method, const QJsonObject &params, const Then<T> &then);
    void showFound(const Findings &found);
    /// changes: all that these settings, in the sample if one is named, mean for the files.
    void showChanges(const QString &sample, const QJsonObject &settings,
                     const std::vector<SettingChange> &changes);
    void showNow(const QString &daemon, QTreeWidgetItem &item);
    void tellApplied(const Applied &applied);
    QString sample() const;

    Fleet &fleet_;
    QPointer<DaemonLink> supervisor_;
    QComboBox *samples_;
    QCheckBox *ask_, *release_;
    QPushButton *find_, *apply_, *undo_;
    QProgressBar *progress_;
    QTreeWidget *found_, *changes_;
    MessageLabel *message_;
    QString folder_; ///< of the settings files
    bool isBusy_ = false, hasSearched_ = false;
    QString changedSample_; ///< what Apply writes: of this sample, with these changes
    QJsonObject changedSettings_;
};

} // namespace hermes::desktop
