//! HTTP in a browser, by `fetch`.

use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

use js_sys::{Reflect, Uint8Array};
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{
    AbortController, Headers, ReadableStreamDefaultReader, RequestInit, Response, WorkerGlobalScope,
};

use super::transport::{Answer, Head, Request, RequestId, Transport, of_running};

/// Requests by the browser, which keeps connections and a cache of its own. Works in a page and in a worker.
#[derive(Default)]
pub struct BrowserTransport {
    next: u64,
    /// What ends each request; `None` for one that could not begin.
    running: BTreeMap<RequestId, Option<AbortController>>,
    answers: Rc<RefCell<VecDeque<(RequestId, Answer)>>>,
}

impl BrowserTransport {
    /// A transport without requests.
    pub fn new() -> Self {
        Self::default()
    }
}

impl Transport for BrowserTransport {
    fn start(&mut self, request: Request) -> RequestId {
        let id = RequestId(self.next);
        self.next += 1;
        let answers = self.answers.clone();
        let send = move |answer| answers.borrow_mut().push_back((id, answer));
        match AbortController::new() {
            Ok(controller) => {
                let signal = controller.signal();
                self.running.insert(id, Some(controller));
                spawn_local(async move {
                    let last = match carry_out(&request, &signal, &send).await {
                        Ok(()) => Answer::End,
                        Err(why) => Answer::Failed(message(&why)),
                    };
                    send(last);
                });
            }
            Err(why) => {
                self.running.insert(id, None);
                send(Answer::Failed(message(&why)));
            }
        }
        id
    }

    fn cancel(&mut self, request: RequestId) {
        if let Some(Some(controller)) = self.running.remove(&request) {
            controller.abort();
        }
    }

    fn poll(&mut self) -> Vec<(RequestId, Answer)> {
        of_running(&mut self.running, self.answers.borrow_mut().drain(..))
    }
}

async fn carry_out(
    request: &Request,
    signal: &web_sys::AbortSignal,
    send: &impl Fn(Answer),
) -> Result<(), JsValue> {
    let headers = Headers::new()?;
    for (name, value) in request.headers() {
        headers.set(name, &value)?;
    }
    let init = RequestInit::new();
    init.set_headers(&headers);
    init.set_signal(Some(signal));
    let answer = JsFuture::from(fetch(&request.url, &init)?).await?;
    let answer: Response = answer.dyn_into()?;
    let header = |name: &str| answer.headers().get(name).ok().flatten();
    send(Answer::Head(Head::read(answer.status(), header)));
    let Some(body) = answer.body() else { return Ok(()) };
    let reader: ReadableStreamDefaultReader = body.get_reader().dyn_into()?;
    loop {
        let part = JsFuture::from(reader.read()).await?;
        if Reflect::get(&part, &"done".into())?.is_truthy() {
            return Ok(());
        }
        let bytes: Uint8Array = Reflect::get(&part, &"value".into())?.dyn_into()?;
        send(Answer::Bytes(bytes.to_vec()));
    }
}

/// `fetch` of the page or of the worker.
fn fetch(url: &str, init: &RequestInit) -> Result<js_sys::Promise, JsValue> {
    let global = js_sys::global();
    if let Some(window) = web_sys::window() {
        return Ok(window.fetch_with_str_and_init(url, init));
    }
    let worker: WorkerGlobalScope = global.dyn_into()?;
    Ok(worker.fetch_with_str_and_init(url, init))
}

fn message(error: &JsValue) -> String {
    let text = Reflect::get(error, &"message".into()).ok().and_then(|text| text.as_string());
    text.unwrap_or_else(|| "the browser refused".to_owned())
}
