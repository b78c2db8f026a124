//! What a shader declares, read from its parsed form: no device needed.

use std::collections::BTreeSet;

use wgpu::naga;

use super::shader::Shader;
use crate::error::{Error, Result};

/// Storage buffers one kernel may use: what every WebGPU device offers.
pub const MAX_STORAGE_BUFFERS: usize = 8;

/// How a kernel uses a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// `var<uniform>`.
    Uniform,
    /// `var<storage, read>`.
    Read,
    /// `var<storage, read_write>`.
    ReadWrite,
}

/// One variable of group 0 that an entry point uses, directly or through functions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Name of the variable.
    pub name: String,
    /// Its `@binding`.
    pub index: u32,
    /// Its address space and access mode.
    pub access: Access,
    /// Bytes the buffer must have at least.
    pub min_bytes: u64,
}

/// A shader parsed and validated, shared by its entry points.
#[derive(Debug)]
pub struct Compiled {
    /// Text and line table.
    pub shader: Shader,
    /// Types, variables, overrides, entry points.
    pub module: naga::Module,
    /// Which entry point uses which variable.
    pub uses: naga::valid::ModuleInfo,
    /// For each entry point the names of the overrides that it reads, directly or through functions.
    overrides: Vec<BTreeSet<String>>,
}

impl Compiled {
    /// Of a parsed and validated text.
    #[must_use]
    pub fn new(shader: Shader, module: naga::Module, uses: naga::valid::ModuleInfo) -> Compiled {
        let overrides = module.entry_points.iter().map(|point| overrides_read(&module, &point.function)).collect();
        Compiled { shader, module, uses, overrides }
    }

    /// Whether an entry point gives other code for another value of `override name`.
    ///
    /// # Errors
    /// [`Error::Shader`] for an unknown entry point.
    pub fn reads_override(&self, entry: &str, name: &str) -> Result<bool> {
        Ok(self.overrides[self.position(entry)?].contains(name))
    }

    /// Names of the compute entry points, in the order of the text.
    pub fn entry_points(&self) -> impl Iterator<Item = &str> {
        self.module.entry_points.iter().map(|point| point.name.as_str())
    }

    /// Names of the overrides that an entry point reads, that need a value and have none among `given`.
    ///
    /// # Errors
    /// [`Error::Shader`] for an unknown entry point.
    pub fn missing_overrides(&self, entry: &str, given: &[(&str, f64)]) -> Result<Vec<&str>> {
        let read = &self.overrides[self.position(entry)?];
        let open = self.module.overrides.iter().filter(|(_, declared)| declared.init.is_none());
        let names = open.filter_map(|(_, declared)| declared.name.as_deref());
        Ok(names.filter(|name| read.contains(*name) && given.iter().all(|(known, _)| known != name)).collect())
    }

    /// Whether the shader declares `override name`.
    #[must_use]
    pub fn has_override(&self, name: &str) -> bool {
        self.module.overrides.iter().any(|(_, declared)| declared.name.as_deref() == Some(name))
    }

    /// The variables an entry point uses, by binding number.
    ///
    /// # Errors
    /// [`Error::Shader`] for an unknown entry point, more than [`MAX_STORAGE_BUFFERS`], and what no kernel can bind.
    pub fn bindings(&self, entry: &str) -> Result<Vec<Binding>> {
        let wrong = |reason: String| Error::Shader(format!("shaders/{}: {entry}: {reason}", self.shader.name));
        let position = self.position(entry)?;
        let uses = self.uses.get_entry_point(position);
        let mut bindings = Vec::new();
        for (handle, variable) in self.module.global_variables.iter() {
            if let Some(place) = variable.binding.filter(|_| !uses[handle].is_empty()) {
                bindings.push(self.binding(variable, place).map_err(wrong)?);
            }
        }
        bindings.sort_by_key(|binding| binding.index);
        let storage = bindings.iter().filter(|binding| binding.access != Access::Uniform).count();
        if storage > MAX_STORAGE_BUFFERS {
            return Err(wrong(format!("uses {storage} storage buffers, at most {MAX_STORAGE_BUFFERS} are allowed")));
        }
        Ok(bindings)
    }

    /// Threads of one workgroup of an entry point.
    ///
    /// # Errors
    /// [`Error::Shader`] for an unknown entry point, or if an override sets the size.
    pub fn threads_per_group(&self, entry: &str) -> Result<u32> {
        let point = &self.module.entry_points[self.position(entry)?];
        if point.workgroup_size_overrides.is_some() {
            let name = &self.shader.name;
            let reason = "the workgroup size must be a constant such as WORKGROUP, not an override";
            return Err(Error::Shader(format!("shaders/{name}: {entry}: {reason}")));
        }
        Ok(point.workgroup_size.iter().product())
    }

    /// Index of an entry point.
    fn position(&self, entry: &str) -> Result<usize> {
        self.entry_points().position(|name| name == entry).ok_or_else(|| {
            let names = self.entry_points().collect::<Vec<_>>().join(", ");
            Error::Shader(format!("shaders/{}: no entry point `{entry}`; there are {names}", self.shader.name))
        })
    }

    /// Reads one variable's declaration.
    fn binding(
        &self,
        variable: &naga::GlobalVariable,
        place: naga::ResourceBinding,
    ) -> std::result::Result<Binding, String> {
        let name = variable.name.clone().unwrap_or_default();
        if place.group != 0 {
            return Err(format!("`{name}` is in group {}, only group 0 is used", place.group));
        }
        let access = match variable.space {
            naga::AddressSpace::Uniform => Access::Uniform,
            naga::AddressSpace::Storage { access } if access.contains(naga::StorageAccess::STORE) => Access::ReadWrite,
            naga::AddressSpace::Storage { .. } => Access::Read,
            _ => return Err(format!("`{name}` is no buffer; kernels bind buffers only")),
        };
        let min_bytes = u64::from(self.module.types[variable.ty].inner.size(self.module.to_ctx()));
        Ok(Binding { name, index: place.binding, access, min_bytes })
    }
}

/// Names of the overrides that a function and those it calls read, and of all that global expressions do.
fn overrides_read(module: &naga::Module, function: &naga::Function) -> BTreeSet<String> {
    let mut read = BTreeSet::new();
    note_overrides(module, &module.global_expressions, &mut read);
    let (mut known, mut left) = (BTreeSet::new(), vec![function]);
    while let Some(function) = left.pop() {
        note_overrides(module, &function.expressions, &mut read);
        let mut called = Vec::new();
        note_calls(&function.body, &mut called);
        left.extend(called.into_iter().filter(|callee| known.insert(*callee)).map(|callee| &module.functions[callee]));
    }
    read
}

fn note_overrides(module: &naga::Module, expressions: &naga::Arena<naga::Expression>, read: &mut BTreeSet<String>) {
    for (_, expression) in expressions.iter() {
        if let naga::Expression::Override(handle) = expression {
            read.extend(module.overrides[*handle].name.clone());
        }
    }
}

fn note_calls(block: &naga::Block, called: &mut Vec<naga::Handle<naga::Function>>) {
    for statement in block {
        match statement {
            naga::Statement::Call { function, .. } => called.push(*function),
            naga::Statement::Block(inner) => note_calls(inner, called),
            naga::Statement::If { accept, reject, .. } => {
                [accept, reject].into_iter().for_each(|inner| note_calls(inner, called))
            }
            naga::Statement::Switch { cases, .. } => cases.iter().for_each(|case| note_calls(&case.body, called)),
            naga::Statement::Loop { body, continuing, .. } => {
                [body, continuing].into_iter().for_each(|inner| note_calls(inner, called));
            }
            _ => {}
        }
    }
}
