//! One entry point with the values of its overrides: what they rule out is left out, for drivers take long to find that themselves.

use std::cell::RefCell;
use std::collections::HashMap;

use wgpu::naga::back::pipeline_constants::process_overrides;
use wgpu::naga::compact::{KeepUnused, compact};
use wgpu::naga::{
    Arena, BinaryOperator, Block, Constant, Expression, Function, Handle, Literal, LocalVariable, Module, ShaderStage,
    Statement, UnaryOperator,
};

use super::reflect::Compiled;

/// A module with this entry point alone, without overrides, without branches that are never taken and without what they alone use.
///
/// # Errors
/// Why the values do not fit the overrides.
pub(super) fn specialised(compiled: &Compiled, entry: &str, overrides: &[(String, f64)]) -> Result<Module, String> {
    let values = overrides.iter().cloned().collect();
    let point = Some((ShaderStage::Compute, entry));
    let (module, _) =
        process_overrides(&compiled.module, &compiled.uses, point, &values).map_err(|error| error.to_string())?;
    let mut module = module.into_owned();
    let mut known =
        Constants { constants: &module.constants, values: &module.global_expressions, answers: HashMap::new() };
    // a function is declared before those that call it
    for (handle, function) in module.functions.iter_mut() {
        if let Some(answer) = prune(&known, function) {
            known.answers.insert(handle, answer);
        }
    }
    for point in &mut module.entry_points {
        prune(&known, &mut point.function);
    }
    // a constant with a name is kept, whether it is used or not
    module.constants.iter_mut().for_each(|(_, constant)| constant.name = None);
    compact(&mut module, KeepUnused::No);
    Ok(module)
}

/// Constants of a module, the expressions that they name, and functions that always give the same truth value.
struct Constants<'a> {
    constants: &'a Arena<Constant>,
    values: &'a Arena<Expression>,
    answers: HashMap<Handle<Function>, bool>,
}

/// Truth values held by variables that the front end makes for `&&` and `||`: it writes each just before it reads it.
type Held = HashMap<Handle<LocalVariable>, bool>;

/// Leaves out the branches of a function that are never taken. The truth value that it gives, if that is always the same.
fn prune(constants: &Constants<'_>, function: &mut Function) -> Option<bool> {
    let body = std::mem::take(&mut function.body);
    let (expressions, variables) = (&function.expressions, &function.local_variables);
    let pruning = Pruning { constants, expressions, variables, returned: RefCell::default() };
    function.body = pruning.block(body, &mut Held::new());
    // A name keeps what it names, also where that was left out.
    function.named_expressions.clear();
    let returned = pruning.returned.take();
    returned.first().copied().flatten().filter(|first| returned.iter().all(|value| *value == Some(*first)))
}

struct Pruning<'a> {
    constants: &'a Constants<'a>,
    expressions: &'a Arena<Expression>,
    variables: &'a Arena<LocalVariable>,
    /// What is known of the values that are returned.
    returned: RefCell<Vec<Option<bool>>>,
}

impl Pruning<'_> {
    /// What is left of a block. It ends where control leaves it.
    fn block(&self, block: Block, held: &mut Held) -> Block {
        let mut left = Block::new();
        for (statement, span) in block.span_into_iter() {
            match statement {
                Statement::If { condition, accept, reject } => match self.truth(condition, held) {
                    Some(taken) => left.extend_block(self.block(if taken { accept } else { reject }, held)),
                    None => {
                        let [accept, reject] = [accept, reject].map(|branch| self.block(branch, &mut held.clone()));
                        left.push(Statement::If { condition, accept, reject }, span);
                    }
                },
                Statement::Block(inner) => left.push(Statement::Block(self.block(inner, held)), span),
                Statement::Loop { body, continuing, break_if } => {
                    let mut inside = held.clone();
                    let [body, continuing] = [body, continuing].map(|inner| self.block(inner, &mut inside));
                    left.push(Statement::Loop { body, continuing, break_if }, span);
                }
                Statement::Switch { selector, mut cases } => {
                    for case in &mut cases {
                        case.body = self.block(std::mem::take(&mut case.body), &mut held.clone());
                    }
                    left.push(Statement::Switch { selector, cases }, span);
                }
                Statement::Store { pointer, value } => {
                    self.hold(pointer, value, held);
                    left.push(Statement::Store { pointer, value }, span);
                }
                Statement::Return { value } => {
                    self.returned.borrow_mut().push(value.and_then(|value| self.truth(value, held)));
                    left.push(Statement::Return { value }, span);
                }
                other => left.push(other, span),
            }
            if left.last().is_some_and(leaves) {
                break;
            }
        }
        left
    }

    /// Notes what a variable of the front end holds.
    fn hold(&self, pointer: Handle<Expression>, value: Handle<Expression>, held: &mut Held) {
        if let Expression::LocalVariable(variable) = self.expressions[pointer]
            && self.variables[variable].name.is_none()
        {
            match self.truth(value, held) {
                Some(value) => held.insert(variable, value),
                None => held.remove(&variable),
            };
        }
    }

    /// The value of a condition, if it is always the same.
    fn truth(&self, condition: Handle<Expression>, held: &Held) -> Option<bool> {
        match self.expressions[condition] {
            Expression::Literal(Literal::Bool(value)) => Some(value),
            Expression::Constant(constant) => match self.constants.values[self.constants.constants[constant].init] {
                Expression::Literal(Literal::Bool(value)) => Some(value),
                _ => None,
            },
            Expression::CallResult(function) => self.constants.answers.get(&function).copied(),
            Expression::Load { pointer } => match self.expressions[pointer] {
                Expression::LocalVariable(variable) => held.get(&variable).copied(),
                _ => None,
            },
            Expression::Unary { op: UnaryOperator::LogicalNot, expr } => self.truth(expr, held).map(|value| !value),
            Expression::Binary { op: BinaryOperator::And | BinaryOperator::LogicalAnd, left, right } => {
                match (self.truth(left, held), self.truth(right, held)) {
                    (Some(false), _) | (_, Some(false)) => Some(false),
                    (Some(true), other) | (other, Some(true)) => other,
                    _ => None,
                }
            }
            Expression::Binary { op: BinaryOperator::InclusiveOr | BinaryOperator::LogicalOr, left, right } => {
                match (self.truth(left, held), self.truth(right, held)) {
                    (Some(true), _) | (_, Some(true)) => Some(true),
                    (Some(false), other) | (other, Some(false)) => other,
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// Whether nothing after a statement of its block is reached.
fn leaves(statement: &Statement) -> bool {
    match statement {
        Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill => true,
        Statement::Block(inner) => inner.last().is_some_and(leaves),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Folder, Shader};

    const TEXT: &str = "
override DIM: u32 = 3u;
override CUT: bool = false;
@group(0) @binding(0) var<storage, read_write> values: array<f32>;
@group(0) @binding(1) var<storage, read_write> apertures: array<f32>;
fn in_space(value: f32) -> f32 { return 3.0 * value; }
fn of_cut(value: f32) -> f32 { apertures[0] = value; return value; }
fn in_plane() -> bool { return DIM < 3u || (DIM == 4u && values[0] > 0.0); }
fn early(value: f32) -> f32 {
    if (!in_plane()) { return in_space(value); }
    return of_cut(value);
}
@compute @workgroup_size(1)
fn main() {
    var sum = values[0];
    for (var k = 0u; k < 4u; k++) {
        if (CUT && DIM == 3u && values[k] > 0.0) { sum += of_cut(values[k]); }
        if (!(CUT || DIM < 3u) || values[k] > 1.0) { sum += early(sum); continue; }
        sum += 1.0;
    }
    values[0] = sum;
}
@compute @workgroup_size(1)
fn other() { apertures[0] = f32(DIM); }
";

    fn left(overrides: &[(&str, f64)]) -> Module {
        let folder = Folder::Given(vec![("text.wgsl".to_owned(), TEXT.to_owned())]);
        let compiled = Shader::load("text.wgsl", "", &folder).unwrap().compile().unwrap();
        let overrides: Vec<_> = overrides.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let module = specialised(&compiled, "main", &overrides).unwrap();
        let flags = wgpu::naga::valid::ValidationFlags::all();
        wgpu::naga::valid::Validator::new(flags, Default::default()).validate(&module).unwrap();
        module
    }

    fn names(module: &Module) -> (Vec<&str>, usize) {
        let functions = module.functions.iter().filter_map(|(_, function)| function.name.as_deref());
        (
            functions.filter(|name| ["in_space", "of_cut", "early"].contains(name)).collect(),
            module.global_variables.len(),
        )
    }

    #[test]
    fn what_overrides_rule_out_is_left_out() {
        let module = left(&[("DIM", 3.0), ("CUT", 0.0)]);
        assert_eq!(names(&module), (vec!["in_space", "early"], 1), "no cut: nobody reads apertures");
        assert_eq!((module.entry_points.len(), module.overrides.len()), (1, 0));
        let text = format!("{:?}", module.entry_points[0].function.body);
        assert_eq!(text.matches("If {").count(), 1, "both conditions are known, the loop's own is not: {text}");
        let values = format!("{:?}", module.entry_points[0].function.expressions);
        assert!(!values.contains("F32(1.0)"), "nothing after `continue` is left: {values}");
    }

    #[test]
    fn what_depends_on_values_is_kept() {
        assert_eq!(names(&left(&[("DIM", 3.0), ("CUT", 1.0)])), (vec!["in_space", "of_cut", "early"], 2));
        assert_eq!(names(&left(&[("DIM", 2.0), ("CUT", 0.0)])), (vec!["of_cut", "early"], 2));
    }
}
