// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "options/option_json.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

namespace vdb_shell::fuzz
{
namespace
{

/// Does what options_from_json() and options_json() do, by a description that is made once: to make
/// one takes longer than to read most files.
class Described
{
public:
    Described() : sections_(describe(options_))
    {
        for (const OptionSection& section : sections_)
            if (section.enable)
                for (const Option& option : section.options)
                    kept_.push_back(option.get());
    }
    Described(const Described&) = delete;
    Described& operator=(const Described&) = delete;

    void read(const std::string& json)
    {
        const nlohmann::ordered_json parsed = parse_options(json, "fuzz");
        forget();
        set_from_json(parsed, sections_, "fuzz");
    }
    const ShellOptions& options() const { return options_; }
    std::string stored() const { return to_json(sections_).dump(2); }

private:
    void forget()
    {
        options_ = ShellOptions();
        // The description of a section that may be off keeps values of its own.
        auto value = kept_.begin();
        for (const OptionSection& section : sections_)
            if (section.enable)
                for (const Option& option : section.options)
                    option.set(*value++);
    }

    ShellOptions options_;
    OptionSections sections_;
    std::vector<OptionValue> kept_;
};

} // namespace

void options(std::string_view bytes)
{
    static Described described;
    const std::string json(bytes);
    try {
        described.read(json);
    } catch (const ReadError&) {
        return;
    } catch (const InvalidOption&) {
        return;
    }
    try {
        require_sensible(described.options());
    } catch (const InvalidOption&) {
    }
    const std::string stored = described.stored();
    described.read(stored);
    require(described.stored() == stored, "stored options come back changed");
    // The calls that others use, of some sizes only: they make five descriptions.
    if (json.size() % 8 != 0)
        return;
    const ShellOptions read = options_from_json(json, {}, "fuzz");
    require(options_json(read) == stored, "options are not what their description says");
    require(options_json(options_from_json(stored)) == stored, "options come back changed");
}

} // namespace vdb_shell::fuzz
