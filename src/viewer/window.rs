//! The window's own device and surface: they draw the user interface and nothing else. A simulation that keeps its device busy for
//! seconds, or loses it, does not stop the window; pictures come to it as bytes.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use egui_wgpu::{RendererOptions, ScreenDescriptor};
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use crate::{Error, Result};

/// Tries to recover a surface before it is given up.
const ATTEMPTS: u32 = 3;

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Painted {
    /// It is on the screen.
    Shown,
    /// The window cannot be seen, or the surface was not ready: nothing was drawn.
    Skipped,
    /// The device is lost; the painter must be made anew.
    DeviceLost,
}

/// Device, surface, and the renderer of the user interface.
pub(super) struct Painter {
    window: Arc<Window>,
    instance: wgpu::Instance,
    surface: wgpu::Surface<'static>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    configuration: wgpu::SurfaceConfiguration,
    renderer: egui_wgpu::Renderer,
    lost: Arc<AtomicBool>,
    fault: Arc<Mutex<Option<String>>>,
}

impl Painter {
    /// Opens a device that can draw to the window.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] if there is none that works.
    pub(super) fn new(window: Arc<Window>, display: OwnedDisplayHandle) -> Result<Self> {
        let descriptor = wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(display));
        let instance = wgpu::Instance::new(descriptor);
        let surface = new_surface(&instance, &window)?;
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            compatible_surface: Some(&surface),
            ..Default::default()
        }))
        .map_err(|error| Error::NoAdapter(format!("no device can draw to a window here ({error}); {HEADLESS}")))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("window"),
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| Error::NoAdapter(format!("the window's device cannot be opened: {error}; {HEADLESS}")))?;
        let (lost, fault) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(None)));
        watch(&device, &lost, &fault);
        let size = window.inner_size();
        let mut configuration = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or_else(|| Error::NoAdapter(format!("the window's surface has no format; {HEADLESS}")))?;
        // Bytes of pictures are sRGB already: a format that does not convert shows them as they are.
        let formats = surface.get_capabilities(&adapter).formats;
        let plain =
            formats.iter().copied().find(|format| !format.is_srgb() && format.target_pixel_byte_cost() == Some(4));
        configuration.format = plain.unwrap_or(configuration.format);
        configuration.present_mode = wgpu::PresentMode::AutoVsync;
        surface.configure(&device, &configuration);
        let options = RendererOptions { dithering: false, ..RendererOptions::default() };
        let renderer = egui_wgpu::Renderer::new(&device, configuration.format, options);
        Ok(Self { window, instance, surface, device, queue, configuration, renderer, lost, fault })
    }

    /// Longest side of a texture.
    pub(super) fn max_texture_side(&self) -> usize {
        self.device.limits().max_texture_dimension_2d as usize
    }

    /// The window has another size; nothing happens while it has none.
    pub(super) fn resize(&mut self, width: u32, height: u32) {
        let most = self.device.limits().max_texture_dimension_2d;
        if width > 0 && height > 0 {
            (self.configuration.width, self.configuration.height) = (width.min(most), height.min(most));
            self.surface.configure(&self.device, &self.configuration);
        }
    }

    /// Draws one frame of the user interface.
    ///
    /// # Errors
    /// [`Error::Gpu`] if the surface cannot be recovered.
    pub(super) fn paint(&mut self, context: &egui::Context, mut output: egui::FullOutput) -> Result<Painted> {
        let scale = output.pixels_per_point;
        for (id, deltas) in &output.textures_delta.set {
            for delta in deltas {
                self.renderer.update_texture(&self.device, &self.queue, *id, delta);
            }
        }
        let painted = self.paint_shapes(&context.tessellate(output.shapes, scale), scale);
        for id in &output.textures_delta.free {
            self.renderer.free_texture(id);
        }
        output.textures_delta.clear();
        if self.lost.load(Ordering::Relaxed) {
            return Ok(Painted::DeviceLost);
        }
        match self.fault.lock().unwrap_or_else(PoisonError::into_inner).take() {
            Some(text) => Err(Error::Bug(format!("drawing the window: {text}; {HEADLESS}"))),
            None => painted,
        }
    }

    fn paint_shapes(&mut self, shapes: &[egui::ClippedPrimitive], scale: f32) -> Result<Painted> {
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Ok(Painted::Skipped);
        }
        let Some(target) = self.target()? else { return Ok(Painted::Skipped) };
        let screen = ScreenDescriptor {
            size_in_pixels: [self.configuration.width, self.configuration.height],
            pixels_per_point: scale,
        };
        let view = target.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
        let mut buffers = self.renderer.update_buffers(&self.device, &self.queue, &mut encoder, shapes, &screen);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        self.renderer.render(&mut pass, shapes, &screen);
        drop(pass);
        buffers.push(encoder.finish());
        self.queue.submit(buffers);
        self.window.pre_present_notify();
        self.queue.present(target);
        Ok(Painted::Shown)
    }

    /// The texture of the next frame; none if there is nothing to draw to just now.
    fn target(&mut self) -> Result<Option<wgpu::SurfaceTexture>> {
        for _ in 0..ATTEMPTS {
            match self.surface.get_current_texture() {
                wgpu::CurrentSurfaceTexture::Success(texture) => return Ok(Some(texture)),
                wgpu::CurrentSurfaceTexture::Suboptimal(texture) => {
                    // Still good to see; a resize event brings the better one.
                    return Ok(Some(texture));
                }
                wgpu::CurrentSurfaceTexture::Timeout | wgpu::CurrentSurfaceTexture::Occluded => return Ok(None),
                wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Validation => {
                    let size = self.window.inner_size();
                    self.resize(size.width, size.height);
                }
                wgpu::CurrentSurfaceTexture::Lost => {
                    self.surface = new_surface(&self.instance, &self.window)?;
                    self.surface.configure(&self.device, &self.configuration);
                }
            }
        }
        // Windows that are being closed or resized come here; the next frame may have more luck.
        Ok(None)
    }
}

/// What to do without a window.
const HEADLESS: &str = "`brisance run SCENE` works without a window";

fn new_surface(instance: &wgpu::Instance, window: &Arc<Window>) -> Result<wgpu::Surface<'static>> {
    instance
        .create_surface(Arc::clone(window))
        .map_err(|error| Error::NoAdapter(format!("the window has no surface to draw to: {error}; {HEADLESS}")))
}

/// Keeps errors and the loss of the device instead of panicking.
fn watch(device: &wgpu::Device, lost: &Arc<AtomicBool>, fault: &Arc<Mutex<Option<String>>>) {
    let fault = Arc::clone(fault);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
    }));
    let lost = Arc::clone(lost);
    device.set_device_lost_callback(move |reason, _| {
        if reason != wgpu::DeviceLostReason::Destroyed {
            lost.store(true, Ordering::Relaxed);
        }
    });
}
