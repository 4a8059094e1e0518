//! The floating-point environment of a call: traps masked, rounding to nearest, subnormal numbers kept; the caller's
//! environment comes back on every way out, its flags included.
//!
//! The core is compiled for the default environment. Kernels divide in all lanes and choose afterwards, and compilers
//! move divisions before the question whether they are wanted; with traps on, any of these would kill the host. Under
//! another rounding the results would differ from those that the tests know.
//!
//! x86-64 has the environment in MXCSR. That of the x87 stays as it is: no code of the library uses it. AArch64 has it
//! in FPCR (control) and FPSR (flags). On other processors nothing is done here: the caller's environment has to be the
//! default one there.

/// The caller's environment; back when this is dropped, by unwinding too.
pub struct FpEnvironment {
    #[cfg(target_arch = "x86_64")]
    mxcsr: u32,
    #[cfg(target_arch = "aarch64")]
    control_and_flags: [u64; 2],
}

#[cfg(target_arch = "x86_64")]
impl FpEnvironment {
    /// Saves the caller's environment and sets the default one.
    #[inline(always)]
    pub fn enter() -> FpEnvironment {
        /// All traps masked, rounding to nearest, no flush to zero, subnormal inputs as they are; no flags.
        static DEFAULT: u32 = 0x1F80;
        let mut mxcsr = 0u32;
        // SAFETY: stores and loads MXCSR; `DEFAULT` has no reserved bit. It is what compiled code relies on.
        unsafe {
            std::arch::asm!(
                "stmxcsr [{saved}]",
                "ldmxcsr [{default}]",
                saved = in(reg) &raw mut mxcsr,
                default = in(reg) &raw const DEFAULT,
                options(nostack)
            );
        }
        FpEnvironment { mxcsr }
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for FpEnvironment {
    #[inline(always)]
    fn drop(&mut self) {
        // SAFETY: loads what was stored on entry. No arithmetic of the library follows before the caller goes on.
        unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const self.mxcsr, options(nostack)) }
    }
}

#[cfg(target_arch = "aarch64")]
impl FpEnvironment {
    /// Saves the caller's environment and sets the default one.
    #[inline(always)]
    pub fn enter() -> FpEnvironment {
        let (control, flags): (u64, u64);
        // SAFETY: reads both registers and sets FPCR to 0, the default one, which compiled code relies on.
        unsafe {
            std::arch::asm!(
                "mrs {control}, fpcr",
                "mrs {flags}, fpsr",
                "msr fpcr, xzr",
                control = out(reg) control,
                flags = out(reg) flags,
                options(nostack)
            );
        }
        FpEnvironment { control_and_flags: [control, flags] }
    }
}

#[cfg(target_arch = "aarch64")]
impl Drop for FpEnvironment {
    #[inline(always)]
    fn drop(&mut self) {
        let [control, flags] = self.control_and_flags;
        // SAFETY: writes what was read on entry. No arithmetic of the library follows before the caller goes on.
        unsafe { std::arch::asm!("msr fpsr, {}", "msr fpcr, {}", in(reg) flags, in(reg) control, options(nostack)) }
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
impl FpEnvironment {
    /// Nothing on this processor.
    #[inline(always)]
    pub fn enter() -> FpEnvironment {
        FpEnvironment {}
    }
}
