//! From a case file to a report, for the command and for Python: the case language ([`case`]), runs ([`run`]),
//! histories in files ([`history`]) and of other programs ([`foreign`], [`grade`]), the report and its JSON document
//! ([`report`]), and the contents of files ([`info`]). Nothing here prints.

pub mod adapt;
pub mod case;
pub mod choice;
pub mod deformation;
mod difference;
pub mod effort;
pub mod export;
mod failure;
mod flight;
pub mod foreign;
pub mod grade;
pub mod history;
pub mod info;
mod leaving;
pub mod memory;
pub mod message;
mod numbering;
pub mod outline;
pub mod outputs;
pub mod plan;
pub mod quantity;
mod reference;
pub mod report;
pub mod restated;
mod resume;
pub mod run;
pub mod saving;
mod step_filter;
mod storing;
pub mod tables;
pub mod until;
pub mod verify;
pub mod writable;

pub use failure::{Failure, inconsistency, kept_results};
