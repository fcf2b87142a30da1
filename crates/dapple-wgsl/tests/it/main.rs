//! Tests of the texts, without a GPU: every module is valid WGSL, alone and in all its flavors.

use dapple_wgsl::{Module, double_value, number_value, source, wesl_package};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Parses and validates a shader.
fn validate(name: &str, text: &str) {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
}

#[test]
fn every_module_is_valid_as_one_file() {
    for &module in Module::ALL {
        validate(module.name(), &module.source());
    }
    validate("all modules", &source(Module::ALL));
}

#[test]
fn naga_oil_imports_all_that_a_module_uses_and_nothing_else() {
    for &module in Module::ALL {
        let text = module.naga_oil();
        let first = text.lines().next();
        let path = format!("#define_import_path dapple::{}", module.name());
        assert_eq!(first, Some(path.as_str()));
        // Resolve the imports as `naga_oil` does: an imported name is declared in the module that it comes from.
        for import in text.lines().filter(|line| line.starts_with("#import")) {
            let (from, names) = import
                .strip_prefix("#import dapple::")
                .and_then(|rest| rest.strip_suffix('}'))
                .and_then(|rest| rest.split_once("::{"))
                .expect("the form of an import");
            let used = module.uses().iter().find(|used| used.name() == from);
            let used = used.expect("a module that is used");
            for name in names.split(", ") {
                let declares = |keyword: &str| used.text().contains(&format!("\n{keyword} {name}"));
                assert!(declares("fn") || declares("struct"), "{from}: {name}");
                assert!(module.text().contains(name), "{import} is not used");
            }
        }
        // The text is that of the plain flavor.
        assert!(text.ends_with(module.text()), "{}", module.name());
    }
}

#[test]
fn modules_list_all_modules_whose_names_they_contain() {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let names = |module: Module| {
        let lines = module.text().lines();
        lines.filter_map(move |line| {
            let rest = line.strip_prefix("fn ").or(line.strip_prefix("struct "))?;
            rest.split(|c| !is_name(c)).next()
        })
    };
    for &module in Module::ALL {
        let code = module
            .text()
            .lines()
            .filter_map(|line| line.split("//").next());
        let words: Vec<_> = code.flat_map(|line| line.split(|c| !is_name(c))).collect();
        for &other in Module::ALL.iter().filter(|&&other| other != module) {
            let mut used = names(other).filter(|name| words.contains(name));
            let is_listed = module.uses().contains(&other);
            assert_eq!(
                used.next().is_some(),
                is_listed,
                "{}: {}",
                module.name(),
                other.name()
            );
        }
    }
}

#[test]
fn wesl_packages_import_what_the_modules_for_naga_oil_import() {
    let files = wesl_package(&[Module::Stamps]);
    let paths: Vec<_> = files.iter().map(|(path, _)| path.as_str()).collect();
    assert_eq!(paths[0], "wesl.toml");
    assert!(paths.contains(&"shaders/stamps.wesl") && paths.contains(&"shaders/root.wesl"));
    assert!(!paths.contains(&"shaders/gabor.wesl"), "it is not used");
    for &module in Module::ALL {
        let imports = |text: &str, start: &str, end: &str| -> Vec<String> {
            let lines = text.lines();
            let lines = lines.filter_map(|line| line.strip_prefix(start)?.strip_suffix(end));
            lines.map(str::to_owned).collect()
        };
        let naga_oil = imports(&module.naga_oil(), "#import dapple::", "");
        assert_eq!(imports(&module.wesl(), "import package::", ";"), naga_oil);
        assert!(module.wesl().ends_with(module.text()), "{}", module.name());
    }
}

#[test]
fn names_suit_naga_oil_which_forbids_digits_at_their_ends() {
    for &module in Module::ALL {
        let parsed = naga::front::wgsl::parse_str(&module.source()).expect("a valid module");
        let functions = parsed.functions.iter();
        let functions = functions.filter_map(|(_, function)| function.name.clone());
        let types = parsed
            .types
            .iter()
            .filter_map(|(_, kind)| kind.name.clone());
        for name in functions.chain(types) {
            assert!(!name.ends_with(|end: char| end.is_ascii_digit()), "{name}");
        }
    }
}

#[test]
fn modules_use_only_earlier_ones_and_are_in_the_order_of_their_variants() {
    for (at, &module) in Module::ALL.iter().enumerate() {
        assert_eq!(module as usize, at, "{}", module.name());
        let mut used = module.uses().iter();
        assert!(used.all(|&used| (used as usize) < at), "{}", module.name());
    }
}

#[test]
fn shaders_are_short() {
    let lines = |module: Module| {
        let source = module.source();
        let lines = source.lines().map(str::trim);
        lines
            .filter(|line| !line.is_empty() && !line.starts_with("//"))
            .count()
    };
    let noise = lines(Module::GradientNoise2d);
    assert!(noise <= 80, "{noise} lines");
    let worley = lines(Module::Worley2d);
    assert!(worley <= 160, "{worley} lines");
}

#[test]
fn literals_have_the_bits_of_their_numbers() {
    // Bit patterns of all exponents and signs, with a step that is a prime number
    let patterns = (0..u32::MAX).step_by(65_537).map(f32::from_bits);
    for number in patterns.filter(|number| number.is_finite()) {
        // Compilers read a decimal as a number of 64 bits, and round it to 32.
        let read: f64 = number_value(number).parse().expect("a number");
        assert_eq!((read as f32).to_bits(), number.to_bits(), "{number}");
    }
    assert_eq!(number_value(-1.0), "-1.0");
    assert_eq!(number_value(0.1), "0.1");
    // 1.5 has the exponent 0 and the upper half of the mantissa.
    assert_eq!(double_value(1.5), "vec2(0x3ff80000u, 0x0u)");
    let constant = format!(
        "const A = {}; const B = {};",
        number_value(3e-39),
        double_value(-0.1)
    );
    validate("constants", &constant);
}
