//! The language itself: what is read, what it means, what is refused.

use sunpeak_cal::{Definitions, Failure, Fault, Inputs, NoInputs};
use sunpeak_core::Location;

fn compile(text: &str, expression: &str) -> Result<sunpeak_cal::Program, String> {
    let mut definitions = Definitions::new();
    definitions.load(text.as_bytes(), "t.cal", "t").map_err(|e| e.to_string())?;
    let at = Location::new("scene.rad", 7, 1);
    let expression = definitions.expression(expression, &at, "t").map_err(|e| e.to_string())?;
    definitions.compile(&[expression], &[2.5, -1.0]).map_err(|e| e.to_string())
}

fn value(text: &str, expression: &str) -> f64 {
    let program = compile(text, expression).expect(expression);
    program.start(&NoInputs).value(0, &[]).expect(expression)
}

#[test]
fn operators_bind_as_in_radiance() {
    for (expression, expected) in [
        ("1 - 2 - 3", -4.0),
        ("8 / 4 / 2 * 3", 3.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-2 ^ 2", 4.0),
        ("2 ^ -1", 0.5),
        ("-(-(3))", 3.0),
        ("+4 * -.5e1", -20.0),
        ("1{ a {nested} comment } + 1", 2.0),
        ("A1 * arg(2) + AC", -0.5),
    ] {
        assert_eq!(value("", expression), expected, "{expression}");
    }
}

#[test]
fn functions_take_functions_and_look_at_arguments_when_needed() {
    let text = "twice(f, x) = f(f(x)); plus(x) = x + 3; v(i) = select(i, 1, 2, 3);
        outer(g) = twice(g, 1); fac(n) = if(n - 1.5, n * fac(n - 1), 1);";
    assert_eq!(value(text, "twice(plus, 1)"), 7.0);
    assert_eq!(value(text, "outer(plus)"), 7.0);
    assert_eq!(value(text, "outer(sq)"), 1.0);
    assert_eq!(value(text, "dot(v, v)"), 14.0);
    assert_eq!(value(text, "fac(10)"), 3_628_800.0);
    assert_eq!(value(text, "select(0, 1, 2, 3)"), 3.0);
    assert_eq!(value(text, "if(0, 1/0, 5)"), 5.0);
    // What a known condition leaves out need not be there.
    assert_eq!(value(text, "if(AC - 2.5, A3, 5)"), 5.0);
}

#[test]
fn names_live_in_contexts() {
    let mut all = Definitions::new();
    all.load(b"a = 1; b = 10; un`P. = 5;", "one", "").expect("global");
    all.load(b"a = 2; c = a + b + un`P.; here = a` + `a;", "two.cal", "two").expect("local");
    let at = Location::default();
    let mut get = |text: &str, context: &str| {
        let expression = all.expression(text, &at, context)?;
        let program = all.compile(&[expression], &[])?;
        Ok::<_, sunpeak_core::Error>(program.start(&NoInputs).value(0, &[]).expect("a value"))
    };
    assert_eq!(get("c", "two").expect("defined"), 17.0);
    assert_eq!(get("here", "two").expect("defined"), 3.0);
    assert_eq!(get("a", "").expect("defined"), 1.0);
    assert!(get("c", "").expect_err("local elsewhere").to_string().contains("\"c\" is not defined"));
}

/// `$1` is x, and `f` counts how often it is asked.
struct Channels(std::cell::Cell<u32>);

impl Inputs for Channels {
    fn channel(&self, number: u32) -> f64 {
        f64::from(number) + 0.5
    }

    fn function(&self, _: u32, arguments: &[f64]) -> Option<f64> {
        self.0.set(self.0.get() + 1);
        arguments.first().copied().filter(|x| *x > 0.0)
    }
}

#[test]
fn a_variable_is_evaluated_once_for_each_set_of_inputs() {
    let mut all = Definitions::new();
    all.name_channel("x", 1);
    all.name_function("f", 0, 1);
    all.load(b"v = f(x) * 2; twice(a) = a + a;", "t.cal", "").expect("reads");
    let at = Location::default();
    let expressions =
        ["v + v + v", "twice(f(x))", "$3", "f(-x) + 1"].map(|t| all.expression(t, &at, "").expect(t));
    let program = all.compile(&expressions, &[]).expect("compiles");
    let inputs = Channels(std::cell::Cell::new(0));
    let mut started = program.start(&inputs);
    assert_eq!(started.value(0, &[]), Ok(9.0));
    assert_eq!((started.value(0, &[]), inputs.0.get()), (Ok(9.0), 1));
    // So is an argument.
    assert_eq!((started.value(1, &[]), inputs.0.get()), (Ok(3.0), 2));
    assert_eq!(started.value(2, &[]), Ok(3.5));
    assert_eq!(started.value(3, &[]), Err(Failure::Math));
}

#[test]
fn calls_from_outside_have_arguments() {
    let mut all = Definitions::new();
    all.load(b"f(a, b) = a - b;", "t.cal", "t").expect("reads");
    let call = all.call("f", 2, &Location::default(), "t");
    let program = all.compile(&[call], &[]).expect("compiles");
    assert_eq!(program.start(&NoInputs).value(0, &[5.0, 3.0]), Ok(2.0));
    assert_eq!(
        (all.parameters("f", "t"), all.parameters("grey", "t"), all.parameters("g", "t")),
        (Some(2), Some(3), None)
    );
}

#[test]
fn mathematics_fails_as_in_radiance() {
    let fails = |expression: &str| {
        compile("", expression).expect(expression).start(&NoInputs).value(0, &[]) == Err(Failure::Math)
    };
    for expression in
        ["1/0", "sqrt(-1)", "log(0)", "exp(1000)", "acos(2) + 1", "0 ^ -1", "select(4, 1, 2)", "mod(1, 0)"]
    {
        assert!(fails(expression), "{expression}");
    }
    // A library function that succeeds later makes it good again; the failed part counts as 0.
    for (expression, expected) in
        [("1/$1 + cos($1)", 1.0), ("sqrt($1 - 1) + exp($1)", 1.0), ("exp(-1000)", 0.0)]
    {
        assert_eq!(value("", expression), expected, "{expression}");
    }
}

#[test]
fn what_is_wrong_is_said_where() {
    for (text, expression, expected) in [
        ("a = 1", "b", "scene.rad:7:1: the variable \"b\" is not defined"),
        ("a = 1;\n f(x) = x + c;", "f(1)", "t.cal:2:13: the variable \"c\" is not defined"),
        ("a = b; b = a;", "a", "is defined by itself"),
        ("a = (1 + 2;", "a", "t.cal:1:11: expected ')', found \";\""),
        ("a = 1 b = 2;", "a", "t.cal:1:7: expected ';' after the definition, found \"b\""),
        ("a = { open", "a", "t.cal:1:5: this comment is not closed"),
        ("f(1) = 2;", "a", "t.cal:1:3: expected the name of a parameter"),
        (
            "",
            "1 +",
            "scene.rad:7:1: in the expression \"1 +\": expected a number, a name or '(', found the end",
        ),
        ("", "1e999", "expected a finite number"),
        ("", "sin()", "expected a number, a name or '('"),
        ("", "atan2(1)", "atan2() is called with 1 arguments: expected 2"),
        ("", "A3", "the real argument A3 is asked for, but only 2 are given"),
        ("", "nothing(1)", "the function \"nothing\" is not defined"),
        ("f(a, b) = b;", "f(1)", "scene.rad:7:1: f() is called with too few arguments"),
        ("", "2(3)", "expected an operator or the end of the expression"),
    ] {
        let message = compile(text, expression).expect_err(expression);
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn hostile_definitions_end_in_a_message() {
    let fault = |text: &str, expression: &str| {
        let program = compile(text, expression).map_err(|message| panic!("{message}")).expect("compiles");
        match program.start(&NoInputs).value(0, &[]) {
            Err(Failure::Fault(fault)) => fault,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(fault("f(x) = f(x + 1) + 1;", "f($1)"), Fault::TooDeep);
    assert_eq!(fault("f(x) = f(x - 1) + f(x - 2);", "f($1)"), Fault::TooDeep);
    assert_eq!(fault("f(n) = if(n, f(n - 1) + f(n - 1), 1);", "f(60 + $1)"), Fault::TooLong);
    assert!(matches!(fault("f(a, b) = b;", "f($1)"), Fault::MissingArgument(_)));
    assert!(matches!(fault("f(a) = a(1);", "f($1)"), Fault::NotAFunction(_)));
    let message = |expression: String| compile("", &expression).expect_err("too deep");
    assert!(message("(".repeat(100_000)).contains("nested more than"));
    assert!(message(format!("2{}", "^2".repeat(100_000))).contains("powers"));
    assert!(message("sin(".repeat(100_000)).contains("nested more than"));
    let chain: String = (0..100_000).map(|i| format!("v{i} = v{} + 1;", i + 1)).collect();
    assert!(compile(&chain, "v0").expect_err("too deep").contains("definitions in terms of each other"));
    // Long is not deep.
    assert_eq!(value("", &format!("1{}", "+1".repeat(100_000))), 100_001.0);
}

#[test]
fn deep_recursion_fits_into_a_small_stack() {
    let work = || {
        assert_eq!(value("sum(n) = if(n - .5, n + sum(n - 1), 0);", "sum(500)"), 125_250.0);
        let endless = compile("f(x) = x * (1 + f(x + 1)) ^ 2;", "f($1)").expect("compiles");
        assert_eq!(endless.start(&NoInputs).value(0, &[]), Err(Failure::Fault(Fault::TooDeep)));
    };
    std::thread::Builder::new()
        .stack_size(2 << 20)
        .spawn(work)
        .expect("a thread")
        .join()
        .expect("no overflow");
}
